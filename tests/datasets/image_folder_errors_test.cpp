#include <string>

#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;

struct BadFolder {
  const char* name;
  const char* file;
  const char* content;  ///< nullptr: the file is left out
  const char* message;  ///< what the message must hold after the folder's path
};

class BadFolders : public testing::TestWithParam<BadFolder> {};

TEST_P(BadFolders, AreRefusedWithFileLineAndRemedy) {
  FolderFixture fixture;
  if (GetParam().content == nullptr) {
    fixture.files.erase(GetParam().file);
  } else {
    fixture.files[GetParam().file] = GetParam().content;
  }
  const auto root = fixture.write();
  const std::string message = input_error_of([&] { const ImageFolder folder(root); });
  EXPECT_EQ(message.find(fixture.mav0().string()), 0U) << message;
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

const char* const kCam = "cam0/data.csv";
const char* const kYaml = "cam0/sensor.yaml";
const char* const kAltimeterYaml = "altimeter0/sensor.yaml";
const char* const kAltimeter = "altimeter0/data.csv";
const char* const kOdometry = "odometry0/data.csv";
const char* const kTruth = "state_groundtruth_estimate0/data.csv";

INSTANTIATE_TEST_SUITE_P(
    Rows, BadFolders,
    testing::Values(
        BadFolder{"NoFrameList", kCam, nullptr, "data.csv: cannot be opened"},
        BadFolder{"Empty", kCam, "", "data.csv: has no data; expected rows of timestamp, filename"},
        BadFolder{"OnlyAHeader", kCam, "#timestamp,filename\n", "data.csv: has no data"},
        BadFolder{"OneColumn", kCam, "#t\n0\n", "data.csv:2: expected 2 columns"},
        BadFolder{"MoreColumns", kAltimeter, "#timestamp,altitude\n0,2,2.5\n",
                  "data.csv:2: expected 2 columns timestamp, altitude, got 3; a first line"},
        BadFolder{"DecimalCommas", kAltimeter, "0,1,62\n",
                  "got 3: decimal commas? expected points"},
        BadFolder{"Semicolons", kAltimeter, "0;2\n",
                  "data.csv:1: expected 2 columns timestamp, "
                  "altitude, got 1: parted by semicolons?"},
        BadFolder{"StampNotANumber", kCam, "0,a.png\nx,b.png\n", "data.csv:2: time stamp 'x'"},
        BadFolder{"StampInSeconds", kCam, "0.5,a.png\n", "is not a whole number of nanoseconds"},
        BadFolder{"StampTooLarge", kCam, "99999999999999999999,a.png\n", "data.csv:1: time stamp"},
        BadFolder{"OutOfOrder", kCam, "1000,a.png\n0,b.png\n",
                  "data.csv:2: time stamp '0' does not come after 1000"},
        BadFolder{"Repeated", kCam, "0,a.png\n#\n0,b.png\n", "data.csv:3: time stamp '0' does not"},
        BadFolder{"PictureMissing", kCam, "0,a.png\n1000,nope.png\n", "nope.png is missing"},
        BadFolder{"PictureNameEmpty", kCam, "0,\n", "is missing"},
        BadFolder{"NoAltimeter", kAltimeter, nullptr, "has no altimeter0/data.csv"},
        BadFolder{"AltitudeZero", kAltimeter, "0,2\n1000,0\n2000,2\n", "data.csv:2: altitude 0 "},
        BadFolder{"AltitudeNegative", kAltimeter, "0,-2\n", "data.csv:1: altitude -2 "},
        BadFolder{"AltitudeNaN", kAltimeter, "0,2\n1000,nan\n2000,2\n", "data.csv:2: 'nan'"},
        BadFolder{"AltitudeEmpty", kAltimeter, "0,\n", "data.csv:1: '' in column 2"},
        BadFolder{"AltitudeEndsEarly", kAltimeter, "0,2\n1000,2\n",
                  "no altitude at or around the picture's time 2000 ns"},
        BadFolder{"AltitudeStartsLate", kAltimeter, "1,2\n1000,2\n2000,2\n",
                  "no altitude at or around the picture's time 0 ns"},
        BadFolder{"AltitudeGap", kAltimeter, "0,2\n1000,2\n2001001001,2\n",
                  "no altitude at or around the picture's time 2000 ns"},
        BadFolder{"AltimeterOutOfOrder", kAltimeter, "0,2\n2000,2\n1000,2\n",
                  "altimeter0/data.csv:3: time stamp"},
        BadFolder{"OdometryShortRow", kOdometry, "0,0,0,0\n", "data.csv:1: expected 7 columns"},
        BadFolder{"OdometryEightColumns", kOdometry, "0,0,0,0,1,1,1,0\n",
                  "step_var_theta, or 10, got 8"},
        BadFolder{"OdometryInfinite", kOdometry, "0,inf,0,0,1,1,1\n", "data.csv:1: 'inf'"},
        BadFolder{"VarianceZero", kOdometry, "0,0,0,0,1,1,1\n1000,0,0,0,1,1,0\n",
                  "odometry0/data.csv:2: the covariance of the step is not positive definite"},
        BadFolder{"VarianceNegative", kOdometry, "0,0,0,0,1,1,1\n1000,0,0,0,-1,1,1\n",
                  "data.csv:2: the covariance"},
        BadFolder{"CovarianceIndefinite", kOdometry, "0,0,0,0,1,1,1\n1000,0,0,0,1,1,1,1.5,0,0\n",
                  "data.csv:2: the covariance"},
        BadFolder{"CovarianceSingular", kOdometry, "0,0,0,0,1,1,1\n1000,0,0,0,1,1,1,0,1,0\n",
                  "data.csv:2: the covariance"},
        BadFolder{"OdometryEndsEarly", kOdometry, "0,0,0,0,1,1,1\n1000,0,0,0,1,1,1\n",
                  "no odometry at or around the picture's time 2000 ns"},
        BadFolder{"QualityFirst", kAltimeter, "#timestamp,quality,altitude [m]\n0,1,2\n",
                  "data.csv:1: names the columns, and altitude is column 3"},
        BadFolder{"TruthOfTum", kTruth,
                  "#timestamp [ns],p_x,p_y,p_z,q_x [],q_y [],q_z [],q_w []\n0,0,0,0,0,0,0,1\n",
                  "data.csv:1: names the columns, and q_w is column 8"},
        BadFolder{"QuaternionZero", kTruth, "0,0,0,0,0,0,0,0\n", "data.csv:1: the quaternion"},
        BadFolder{"QuaternionIsYaw", kTruth, "0,0,0,0,0,0,0,1.57\n", "data.csv:1: the quaternion"},
        BadFolder{"TruthShortRow", kTruth, "0,0,0,0\n", "data.csv:1: expected 8 columns"}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

#define FATHOM_YAML(resolution, intrinsics, more) \
  "resolution: " resolution "\nintrinsics: " intrinsics "\n" more "\n"

INSTANTIATE_TEST_SUITE_P(
    Camera, BadFolders,
    testing::Values(
        BadFolder{"NoYaml", kYaml, nullptr, "sensor.yaml: cannot be opened"},
        BadFolder{"EmptyYaml", kYaml, "", "sensor.yaml: expected the keys"},
        BadFolder{"BrokenYaml", kYaml, "a: 1\nresolution: [8, 6\n", "is not valid YAML"},
        BadFolder{"NoResolution", kYaml, "intrinsics: [1, 1, 1, 1]\n",
                  "sensor.yaml: key resolution is missing"},
        BadFolder{"NoIntrinsics", kYaml, "resolution: [8, 6]\n", "key intrinsics is missing"},
        BadFolder{"ResolutionOfOne", kYaml, FATHOM_YAML("[8]", "[1, 1, 1, 1]", ""),
                  "sensor.yaml:1: resolution"},
        BadFolder{"ResolutionZero", kYaml, FATHOM_YAML("[8, 0]", "[1, 1, 1, 1]", ""),
                  "sensor.yaml:1: resolution: expected whole"},
        BadFolder{"ResolutionBroken", kYaml, FATHOM_YAML("[8, 6.5]", "[1, 1, 1, 1]", ""),
                  "sensor.yaml:1: resolution: expected whole"},
        BadFolder{"ResolutionNotThePictures", kYaml, FATHOM_YAML("[8, 7]", "[9, 9, 4, 3]", ""),
                  "a.png: has 8 x 6 pixels, expected the resolution of sensor.yaml, 8 x 7"},
        BadFolder{"FocalLengthNegative", kYaml, FATHOM_YAML("[8, 6]", "[-9, 9, 4, 3]", ""),
                  "sensor.yaml:2: intrinsics: focal lengths"},
        BadFolder{"FocalLengthNaN", kYaml, FATHOM_YAML("[8, 6]", "[.nan, 9, 4, 3]", ""),
                  "sensor.yaml:2: intrinsics: expected a number"},
        BadFolder{"UnknownDistortion", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "distortion_model: plumb_bob"),
                  "sensor.yaml:3: distortion_model: 'plumb_bob' is unknown"},
        BadFolder{"CoefficientsMissing", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "distortion_model: radial-tangential"),
                  "key distortion_coefficients is missing"},
        BadFolder{"CoefficientsOfThree", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]",
                              "distortion_model: radial-tangential\n"
                              "distortion_coefficients: [0, 0, 0]"),
                  "sensor.yaml:4: distortion_coefficients"},
        BadFolder{"CoefficientsWithoutModel", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]",
                              "distortion_model: none\ndistortion_coefficients: [0.1, 0, 0, 0]"),
                  "sensor.yaml:4: distortion_coefficients"},
        BadFolder{"DistortionFolds", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]",
                              "distortion_model: radial-tangential\n"
                              "distortion_coefficients: [-9, 0, 0, 0]"),
                  "sensor.yaml: camera distortion"},
        BadFolder{"MountingTypo", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "mounting: {yawn: 0.1}"),
                  "sensor.yaml:3: mounting: 'yawn' is unknown"},
        BadFolder{"MountingText", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "mounting: {x: left}"),
                  "sensor.yaml:3: mounting.x: expected a number"},
        BadFolder{"MountingList", kYaml, FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "mounting: [1, 2]"),
                  "sensor.yaml:3: mounting: expected"},
        BadFolder{"NegativeSigma", kAltimeterYaml, "sigma_absolute: -0.1\n",
                  "altimeter0/sensor.yaml:1: sigma_absolute: '-0.1' is no standard deviation"},
        BadFolder{"KeyTwice", kAltimeterYaml, "scale: 1\nscale: 0.5\n",
                  "altimeter0/sensor.yaml:2: 'scale' is given twice"},
        BadFolder{"CameraKeyTwice", kYaml,
                  FATHOM_YAML("[8, 6]", "[9, 9, 4, 3]", "mounting: {x: 1, x: 2}"),
                  "sensor.yaml:3: 'x' is given twice"},
        BadFolder{"OutliersUnknown", kAltimeterYaml, "outliers: kep\n",
                  "altimeter0/sensor.yaml:1: outliers: 'kep' is unknown; expected leave_out or "
                  "keep; did you mean 'keep'?"},
        BadFolder{"OdometryYamlBroken", "odometry0/sensor.yaml", "a: [b\n",
                  "odometry0/sensor.yaml:2: is not valid YAML"},
        BadFolder{"SigmaNotANumber", kAltimeterYaml, "a: 1\nsigma_absolute: .nan\n",
                  "altimeter0/sensor.yaml:2: sigma_absolute: '.nan' is no standard deviation"},
        BadFolder{"SigmaInPercent", kAltimeterYaml, "sigma_relative: 3\n",
                  "sigma_relative: '3' is no standard deviation; expected a share of the reading"},
        BadFolder{"SigmaList", kAltimeterYaml, "sigma_relative: [0.1]\n",
                  "sigma_relative: what stands here is no standard deviation"}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

TEST(ImageFolderErrors, FolderThatIsNone) {
  const FolderFixture fixture;
  const auto missing = fixture.root / "nope";
  EXPECT_NE(input_error_of([&] { const ImageFolder f(missing); }).find("is no folder"),
            std::string::npos);
  EXPECT_NE(input_error_of([&] {
              const ImageFolder f(fixture.root.path());
            }).find("expected a folder in the EuRoC/ASL layout"),
            std::string::npos);
}

TEST(ImageFolderErrors, SensorFolderWithoutDataIsNoAbsence) {
  FolderFixture fixture;
  fixture.files.erase(kOdometry);
  const auto root = fixture.write();
  std::filesystem::create_directories(fixture.mav0() / "odometry0");
  EXPECT_NE(input_error_of([&] { const ImageFolder f(root); }).find("odometry0/data.csv"),
            std::string::npos);
}

TEST(ImageFolderErrors, UnreadablePicturesAreNamed) {
  const FolderFixture fixture;
  const auto root = fixture.write();
  const auto picture = fixture.mav0() / "cam0/data/c.png";
  for (const std::string content : {"", "no picture", "\x89PNG\r\n\x1a\n"}) {
    std::ofstream(picture, std::ios::trunc | std::ios::binary) << content;
    const ImageFolder folder(root);
    EXPECT_EQ(input_error_of([&] { folder.image(2); }).find(picture.string() + ": is no picture"),
              0U);
  }
  test::write_picture(picture, cv::Mat(5, 8, CV_8UC1, cv::Scalar(3)));
  const ImageFolder folder(root);
  EXPECT_EQ(input_error_of([&] { folder.image(2); }).find(picture.string() + ": has 8 x 5 pixels"),
            0U);
  std::filesystem::remove(picture);
  EXPECT_EQ(input_error_of([&] { folder.image(2); }).find(picture.string() + ": cannot be opened"),
            0U);
}

// Decoders of both formats make do with what is there.
TEST(ImageFolderErrors, PictureCutShortIsRefused) {
  FolderFixture fixture;
  for (const std::string name : {"cut.jpg", "cut.png"}) {
    fixture.files["cam0/data.csv"] = "0,a.png\n1000," + name + "\n";
    const auto picture = fixture.mav0() / "cam0/data" / name;
    std::filesystem::create_directories(picture.parent_path());
    ASSERT_TRUE(test::write_picture(picture, cv::Mat(6, 8, CV_8UC1, cv::Scalar(77))));
    const ImageFolder folder(fixture.write());
    EXPECT_EQ(input_error_of([&] { folder.image(1); }), "(nothing thrown)");
    std::filesystem::resize_file(picture, std::filesystem::file_size(picture) - 20);
    EXPECT_EQ(input_error_of([&] { folder.image(1); }).find(picture.string() + ": is no picture"),
              0U);
  }
}

TEST(ImageFolderErrors, NothingHalfWrittenIsLeft) {
  const FolderFixture fixture;
  const ImageFolder folder(fixture.write());
  std::filesystem::remove(fixture.mav0() / "cam0/data/c.png");
  const auto out = fixture.root / "new";
  EXPECT_NE(input_error_of([&] { write_image_folder(folder, out); }), "(nothing thrown)");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace fathom
