// What an image folder has that is unlike others, and would go unnoticed: folders that are nearly
// called like sensors, and numbers of a camera that few cameras have.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "fathom/datasets/camera_doubts.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// What is said of the folder with these others in it.
std::vector<std::string> said_of(const FolderFixture& fixture,
                                 const std::vector<std::string>& names) {
  for (const std::string& name : names) std::filesystem::create_directories(fixture.mav0() / name);
  return ImageFolder(fixture.write()).remarks();
}

TEST(UnlikeFolders, AMisspeltSensorIsNamedWithTheOneThatIsMeant) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"attitude", "attitude0"},      {"attitude_0", "attitude0"},
      {"Attitude0", "attitude0"},     {"attitde0", "attitude0"},
      {"compas0", "compass0"},        {"compass", "compass0"},
      {"position", "position0"},      {"odom0", "odometry0"},
      {"odometry", "odometry0"},      {"groundtruth0", "state_groundtruth_estimate0"},
      {"odometer0", "odometry0"},     {"ground_truth", "state_groundtruth_estimate0"},
      {"odometry_0.bak", "odometry0"}};
  for (const auto& [name, meant] : cases) {
    FolderFixture fixture;
    fixture.files.erase(meant + "/data.csv");
    EXPECT_THAT(said_of(fixture, {name}),
                ElementsAre((fixture.mav0() / name).string() + " is not read; did you mean '" +
                            meant + "'?"));
  }
}

TEST(UnlikeFolders, OtherSensorsAreNoMisspeltOnes) {
  const FolderFixture fixture;
  EXPECT_THAT(
      said_of(fixture, {"imu0", "cam1", "leica0", "vicon0", "mocap0", "gps0", "dvl0", "depth0",
                        "pressure0", "heading0", "magnetometer0", "barometer0", "accelerometer0",
                        "gyro0", "sonar0", "pointcloud0", "events0", ".attitude0", "0"}),
      IsEmpty());
}

TEST(UnlikeFolders, FilesAreNoSensors) {
  FolderFixture fixture;
  fixture.files["body.yaml"] = "comment: none\n";
  fixture.files["attitude"] = "";
  EXPECT_THAT(said_of(fixture, {}), IsEmpty());
}

TEST(UnlikeFolders, ASecondSensorIsNamedBesideTheOneThatIsRead) {
  const FolderFixture fixture;
  EXPECT_THAT(said_of(fixture, {"altimeter1", "odometry_old"}),
              ElementsAre(EndsWith("mav0/altimeter1 is not read, as altimeter0 is there")));
}

TEST(UnlikeFolders, TheRefusalOfAFolderWithoutAltitudesNamesWhatMayHoldThem) {
  for (const std::string name : {"altimter0", "altimeter1", "altimeter", "altitude0"}) {
    FolderFixture fixture;
    fixture.files.erase("altimeter0/data.csv");
    std::filesystem::create_directories(fixture.mav0() / name);
    const auto root = fixture.write();
    EXPECT_THAT(test::input_error_of([&] { const ImageFolder folder(root); }),
                AllOf(HasSubstr("has no altimeter0/data.csv; "),
                      EndsWith("; rename " + name + " to altimeter0 if that is what it holds")));
  }
  FolderFixture without;
  without.files.erase("altimeter0/data.csv");
  const auto root = without.write();
  EXPECT_THAT(test::input_error_of([&] { const ImageFolder folder(root); }),
              EndsWith("become metres"));
}

TEST(UnlikeFolders, TheRefusalOfAFolderWithoutACameraNamesWhatMayBeOne) {
  const FolderFixture fixture;
  const auto root = fixture.write();
  std::filesystem::rename(fixture.mav0() / "cam0", fixture.mav0() / "camera0");
  for (const auto& path : {root, fixture.mav0()}) {
    EXPECT_THAT(test::input_error_of([&] { const ImageFolder folder(path); }),
                EndsWith("; rename camera0 to cam0 if that is what it holds"));
  }
}

CameraModel camera_with(double fx, double fy, double cx, double cy) {
  CameraModel camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  return camera;
}

TEST(UnlikeCameras, PixelsThatAreNotSquare) {
  EXPECT_THAT(camera_doubts(camera_with(170, 128, 79.5, 59.5), "c"),
              ElementsAre(HasSubstr("c: fx 170 and fy 128 differ by 28 %; pixels are square in "
                                    "nearly all cameras")));
  EXPECT_THAT(camera_doubts(camera_with(128, 170.25, 79.5, 59.5), "c"),
              ElementsAre(HasSubstr("fx 128 and fy 170.25 differ by 28 %")));
  EXPECT_THAT(camera_doubts(camera_with(128, 134, 79.5, 59.5), "c"), IsEmpty());
  EXPECT_THAT(camera_doubts(CameraModel{}, "c"), IsEmpty());
}

TEST(UnlikeCameras, APrincipalPointThatLooksExchanged) {
  EXPECT_THAT(camera_doubts(camera_with(128, 128, 59.5, 79.5), "c"),
              ElementsAre("c: cx 59.5 and cy 79.5 look exchanged in pictures of 160 x 120; write "
                          "cx 79.5 and cy 59.5, unless the pictures are a part that was cut out"));
  EXPECT_THAT(camera_doubts(camera_with(128, 128, 67, 72), "c"), Not(IsEmpty()));
  // Off the middle, but not to there; and near the middle of nearly square pictures.
  EXPECT_THAT(camera_doubts(camera_with(128, 128, 99.5, 39.5), "c"), IsEmpty());
  EXPECT_THAT(camera_doubts(camera_with(128, 128, 72, 66), "c"), IsEmpty());
  CameraModel square = camera_with(128, 128, 59.5, 63.5);
  square.width = 128;
  EXPECT_THAT(camera_doubts(square, "c"), IsEmpty());
}

TEST(UnlikeCameras, ASurveySaysSo) {
  FolderFixture fixture;
  fixture.files["cam0/sensor.yaml"] = "resolution: [8, 6]\nintrinsics: [13, 10, 2.5, 3.5]\n";
  EXPECT_THAT(said_of(fixture, {}),
              ElementsAre(HasSubstr("mav0/cam0/sensor.yaml: fx 13 and fy 10 differ by 26 %"),
                          HasSubstr("mav0/cam0/sensor.yaml: cx 2.5 and cy 3.5 look exchanged")));
  PictureFolderOptions options;
  options.path = (fixture.mav0() / "cam0/data").string();
  options.altitude_m = 2.0;
  options.focal_px = 13.0;
  options.focal_y_px = 10.0;
  EXPECT_THAT(PictureFolder(options).remarks(),
              Contains(HasSubstr("dataset.camera: fx 13 and fy 10 differ by 26 %")));
}

}  // namespace
}  // namespace fathom
