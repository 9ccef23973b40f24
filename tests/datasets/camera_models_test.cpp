// Models of distortion in files and configurations; what they mean is tested with Camera.

#include <fstream>

#include <gmock/gmock.h>

#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "fathom/datasets/camera_options.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "small_survey.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr std::array<double, 8> kEightNumbers{0.06, 0.01, 0.002, 0.003, 0.004, 0.05, 0.02, 0.001};

CameraModel bent_by(const DistortionEntry& entry) {
  CameraModel model;
  model.distortion_model = entry.model;
  std::copy_n(kEightNumbers.begin(), entry.coefficients.size(), model.distortion.begin());
  return model;
}

class CameraModels : public ::testing::Test {
 protected:
  Camera read(const std::string& lines) const {
    std::ofstream(folder_ / "sensor.yaml")
        << "resolution: [640, 480]\nintrinsics: [500, 500, 319.5, 239.5]\n"
        << lines;
    return read_camera_yaml(folder_ / "sensor.yaml");
  }
  std::string refusal(const std::string& lines) const {
    return test::input_error_of([&] { read(lines); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(CameraModels, SensorYamlKeepsEachOfThem) {
  for (const DistortionEntry& entry : distortion_models()) {
    const CameraModel model = bent_by(entry);
    std::ofstream(folder_ / "a.yaml") << camera_yaml(model);
    const CameraModel back = read_camera_yaml(folder_ / "a.yaml").model();
    EXPECT_EQ(back.distortion_model, entry.model);
    EXPECT_EQ(back.distortion, model.distortion) << entry.name;
  }
  // A fisheye bends without coefficients, too.
  CameraModel ideal;
  ideal.distortion_model = DistortionModel::equidistant;
  std::ofstream(folder_ / "a.yaml") << camera_yaml(ideal);
  EXPECT_EQ(read_camera_yaml(folder_ / "a.yaml").model().distortion_model, ideal.distortion_model);
}

TEST_F(CameraModels, SensorYamlOfAFisheye) {
  const Camera camera =
      read("distortion_model: equidistant\ndistortion_coefficients: [0.1, 0, 0, 0.01]\n");
  EXPECT_EQ(camera.model().distortion, (std::array<double, 8>{0.1, 0, 0, 0.01}));
  // 250 pixels are half a focal length: 0.5 = θ + 0.1 θ³ + 0.01 θ⁹, by bisection.
  const double angle = std::atan(-camera.floor_point({569.5, 239.5}, 1.0).y());
  EXPECT_NEAR(angle + 0.1 * std::pow(angle, 3) + 0.01 * std::pow(angle, 9), 0.5, 1e-12);
}

TEST_F(CameraModels, SensorYamlThatIsWrongIsNamed) {
  EXPECT_THAT(refusal("distortion_model: equidistant\ndistortion_coefficients: [0, 0, 0, 0, 0]\n"),
              HasSubstr("sensor.yaml:4: distortion_coefficients: expected [k1, k2, k3, k4]"));
  EXPECT_THAT(refusal("distortion_model: rational_polynomial\n"
                      "distortion_coefficients: [0, 0, 0, 0, 0]\n"),
              HasSubstr("expected [k1, k2, p1, p2, k3, k4, k5, k6]"));
  EXPECT_THAT(refusal("distortion_model: radial-tangential\ndistortion_coefficients: [0, 0]\n"),
              HasSubstr("expected [k1, k2, p1, p2] or [k1, k2, p1, p2, k3]"));
  EXPECT_THAT(refusal("distortion_model: equidistent\n"),
              HasSubstr("sensor.yaml:3: distortion_model: 'equidistent' is unknown; expected one "
                        "of none, radial-tangential, equidistant, rational_polynomial; did you "
                        "mean 'equidistant'?"));
  EXPECT_THAT(refusal("distortion_model: equidistant\ndistortion_coefficients: [-2, 0, 0, 0]\n"),
              HasSubstr("sensor.yaml: camera distortion folds the picture over"));
}

TEST_F(CameraModels, ASimulatedSurveyOfAFisheyeComesBackFromItsFolder) {
  SimulatedSurveyOptions options = test::full_survey();
  options.camera.base.distortion_model = DistortionModel::equidistant;
  options.camera.distortion = {0.01, 0.02, -0.003, 0.001};
  const SimulatedSurvey survey(options, 6);
  write_image_folder(survey, folder_ / "out");
  const ImageFolder read(folder_ / "out");
  EXPECT_EQ(read.camera().model().distortion_model, DistortionModel::equidistant);
  EXPECT_EQ(read.camera().model().distortion, survey.camera().model().distortion);
  EXPECT_THAT(summarise_frames(read).facts, Contains(HasSubstr("equidistant distortion")));
  options.camera.base.distortion_model = DistortionModel::rational_polynomial;
  EXPECT_THAT(test::input_error_of([&] { SimulatedSurvey(options, 6); }),
              HasSubstr("dataset.camera.distortion: expected the 8 numbers [k1, k2, p1, p2, k3, "
                        "k4, k5, k6] of rational_polynomial distortion, or []"));
}

TEST_F(CameraModels, OptionsTakeTheNameOfTheModel) {
  CameraOptions options;
  OptionTable table;
  table.group("camera", options);
  table.set("camera.distortion_model", OptionValue::scalar("rational_polynomial"));
  table.set("camera.distortion",
            OptionValue{{"0.06", "0.01", "0", "0", "0", "0.05", "0", "0"}, true});
  const CameraModel model = options.model("camera.");
  EXPECT_EQ(model.distortion_model, DistortionModel::rational_polynomial);
  EXPECT_EQ(model.distortion[5], 0.05);
}

TEST_F(CameraModels, AFieldOfViewIsThatOfTheFisheye) {
  test::write_picture(folder_ / "a.png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(90)));
  PictureFolderOptions options;
  options.path = folder_.path().string();
  options.altitude_m = 2.0;
  options.field_of_view_rad = 2.0;
  options.distortion_model = DistortionModel::equidistant;
  options.distortion = {0.05, -0.02, 0.003, 0.001};
  const Camera camera = PictureFolder(options).camera();
  EXPECT_NEAR(std::atan(camera.floor_point({-0.5, 2.5}, 1.0).y()), 1.0, 1e-12);
  options.distortion = {0.05};
  EXPECT_THAT(test::input_error_of([&] { PictureFolder folder(options); }),
              HasSubstr("dataset.camera.distortion: expected the 4 numbers"));
}

TEST_F(CameraModels, AFieldOfViewIsThatOfADistortedLensToo) {
  test::write_picture(folder_ / "a.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(90)));
  PictureFolderOptions options;
  options.path = folder_.path().string();
  options.altitude_m = 2.0;
  options.field_of_view_rad = 1.2;
  const auto covered_rad = [&] {
    const Camera camera = PictureFolder(options).camera();
    return std::atan(camera.floor_point({-0.5, 23.5}, 1.0).y()) -
           std::atan(camera.floor_point({63.5, 23.5}, 1.0).y());
  };
  options.distortion = {-0.2, 0.0, 0.0, 0.0, 0.0};
  EXPECT_NEAR(covered_rad(), 1.2, 1e-9);
  options.distortion_model = DistortionModel::rational_polynomial;
  options.distortion = {0.06, 0.01, 0.0, 0.0, 0.0, 0.3, 0.0, 0.0};
  EXPECT_NEAR(covered_rad(), 1.2, 1e-9);
  // 0.68 focal lengths from the axis this lens shows what is nearer to it as well.
  options.distortion_model = DistortionModel::radial_tangential;
  options.distortion = {-1.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_THAT(test::input_error_of([&] { PictureFolder folder(options); }),
              HasSubstr("dataset.camera.field_of_view_rad: the lens of dataset.camera.distortion "
                        "shows no such angle"));
}

class ColmapCamera : public CameraModels {
 protected:
  ImportReport import(const std::string& cameras, const std::string& second_camera = "7") const {
    const std::filesystem::path model = folder_ / "model";
    std::filesystem::create_directories(model);
    // Two cameras a metre above one another look down.
    std::ofstream(model / "images.txt")
        << "1 0 1 0 0 0 0 2 7 a.png\n\n2 0 1 0 0 1 0 2 " << second_camera << " b.png\n\n";
    std::ofstream(model / "cameras.txt") << "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"
                                         << cameras;
    std::filesystem::create_directories(folder_ / "out");
    std::filesystem::remove(folder_ / "out" / "sensor.yaml");
    return import_colmap(model, {}, folder_ / "out");
  }
  CameraModel camera_after(const std::string& cameras) const {
    import(cameras);
    return read_camera_yaml(folder_ / "out" / "sensor.yaml").model();
  }
};

TEST_F(ColmapCamera, FisheyeAndFullModelHaveTheirCoefficients) {
  const CameraModel fisheye = camera_after(
      "3 SIMPLE_PINHOLE 10 10 5 5 5\n7 OPENCV_FISHEYE 640 480 400 401 320 241 0.1 0.2 0.03 0.04\n");
  EXPECT_EQ(fisheye.width, 640);
  EXPECT_EQ(fisheye.height, 480);
  EXPECT_EQ(fisheye.fx, 400.0);
  EXPECT_EQ(fisheye.fy, 401.0);
  // COLMAP counts from the corner of the first pixel.
  EXPECT_EQ(fisheye.cx, 319.5);
  EXPECT_EQ(fisheye.cy, 240.5);
  EXPECT_EQ(fisheye.distortion_model, DistortionModel::equidistant);
  EXPECT_EQ(fisheye.distortion, (std::array<double, 8>{0.1, 0.2, 0.03, 0.04}));
  const CameraModel full = camera_after(
      "7 FULL_OPENCV 640 480 400 401 320 241 0.06 0.01 0.002 0.003 0.004 0.05 0.02 0.001\n");
  EXPECT_EQ(full.distortion_model, DistortionModel::rational_polynomial);
  EXPECT_EQ(full.distortion, kEightNumbers);
  const CameraModel radial = camera_after("7 RADIAL 640 480 400 320 241 0.1 0.02\n");
  EXPECT_EQ(radial.fy, 400.0);
  EXPECT_EQ(radial.distortion_model, DistortionModel::radial_tangential);
  EXPECT_EQ(radial.distortion, (std::array<double, 8>{0.1, 0.02}));
}

TEST_F(ColmapCamera, WhereThereIsNoneANoteSaysWhy) {
  const auto note = [&](const std::string& cameras, const std::string& second = "7") {
    const ImportReport report = import(cameras, second);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "sensor.yaml"));
    return joined(report.notes, "\n");
  };
  const std::string pinhole = "7 PINHOLE 640 480 400 400 320 240\n";
  EXPECT_THAT(note("7 FOV 640 480 400 400 320 240 0.9\n"), HasSubstr("'FOV' is not read"));
  EXPECT_THAT(note("7 RADIAL 640 480 400 320 240 -3 0\n"), HasSubstr("folds the picture over"));
  EXPECT_THAT(note(pinhole + "8 PINHOLE 640 480 400 400 320 240\n", "8"),
              HasSubstr("the images are of 2 cameras"));
  EXPECT_THAT(note("7 OPENCV 640 480 400 320 240 0\n"), HasSubstr("does not have 4 parameters"));
  const auto refusal = [&](const std::string& cameras) {
    return test::input_error_of([&] { import(cameras); });
  };
  EXPECT_THAT(refusal("3 PINHOLE 640 480 400 400 320 240\n"), HasSubstr("has no camera 7"));
  EXPECT_THAT(refusal("7 PINHOLE 640 none 400\n"), HasSubstr("cameras.txt:2: expected CAMERA_ID"));
}

}  // namespace
}  // namespace fathom
