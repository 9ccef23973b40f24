#include "fathom/datasets/image_folder.hpp"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "folder_fixture.hpp"
#include "small_survey.hpp"
#include "support/data.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::TemporaryFolder;

void expect_same_frames(const FrameSource& a, const FrameSource& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.has_odometry(), b.has_odometry());
  EXPECT_EQ(a.has_ground_truth(), b.has_ground_truth());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const FrameInfo& x = a.info(i);
    const FrameInfo& y = b.info(i);
    EXPECT_EQ(x.time_ns, y.time_ns);
    EXPECT_EQ(x.altitude_m, y.altitude_m);
    ASSERT_EQ(x.motion.has_value(), y.motion.has_value());
    if (x.motion) {
      EXPECT_LT(test::distance(x.motion->mean, y.motion->mean), 1e-12) << i;
      EXPECT_EQ(x.motion->covariance, y.motion->covariance) << i;
    }
    ASSERT_EQ(x.ground_truth.has_value(), y.ground_truth.has_value());
    if (x.ground_truth) {
      EXPECT_LT(test::distance(*x.ground_truth, *y.ground_truth), 1e-12) << i;
    }
    EXPECT_EQ(cv::norm(a.image(i), b.image(i), cv::NORM_INF), 0.0) << i;
  }
}

void expect_same_camera(const CameraModel& a, const CameraModel& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.distortion_model, b.distortion_model);
  EXPECT_EQ(a.distortion, b.distortion);
  EXPECT_EQ(a.mount_x_m, b.mount_x_m);
  EXPECT_EQ(a.mount_y_m, b.mount_y_m);
  EXPECT_EQ(a.mount_yaw_rad, b.mount_yaw_rad);
}

TEST(ImageFolderRoundTrip, FullSurveyComesBack) {
  const TemporaryFolder folder;
  const SimulatedSurvey survey(test::full_survey(), 6);
  write_image_folder(survey, folder / "out");
  const ImageFolder read(folder / "out");
  expect_same_camera(survey.camera().model(), read.camera().model());
  expect_same_frames(survey, read);
  EXPECT_NE(read.info(1).motion->covariance(0, 1), 0.0);
}

TEST(ImageFolderRoundTrip, WritingWhatWasReadChangesNothing) {
  const TemporaryFolder folder;
  write_image_folder(SimulatedSurvey(test::full_survey(), 6), folder / "once");
  const ImageFolder once(folder / "once");
  write_image_folder(once, folder / "twice");
  expect_same_frames(once, ImageFolder(folder / "twice"));
}

TEST(ImageFolderRoundTrip, WithoutOdometryThereIsNoneAfter) {
  const TemporaryFolder folder;
  SimulatedSurveyOptions options = test::small_survey();
  options.odometry.source = OdometrySource::kVisualOdometry;
  const SimulatedSurvey survey(options, 1);
  write_image_folder(survey, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "mav0" / "odometry0"));
  expect_same_frames(survey, ImageFolder(folder.path()));
}

TEST(ImageFolderRoundTrip, ReplacesAnOlderOneWhole) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "mav0" / "cam0" / "data");
  std::ofstream(folder / "mav0" / "cam0" / "data" / "old.png") << "old";
  std::ofstream(folder / "notes.txt") << "kept";
  write_image_folder(SimulatedSurvey(test::small_survey(), 1), folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "mav0" / "cam0" / "data" / "old.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "notes.txt"));
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++entries;
  }
  EXPECT_EQ(entries, 2U);
}

TEST(ImageFolder, ReadsTheFolderOrItsMav0) {
  const FolderFixture fixture;
  const ImageFolder outer(fixture.write());
  const ImageFolder inner(fixture.mav0());
  expect_same_frames(outer, inner);
  ASSERT_EQ(outer.size(), 3U);
  EXPECT_EQ(outer.info(1).altitude_m, 2.5);
  EXPECT_EQ(outer.info(2).ground_truth->y, 2.0);
  EXPECT_EQ(outer.image(0).at<uchar>(1, 0), 40);
  EXPECT_FALSE(outer.info(0).motion.has_value());
}

TEST(ImageFolder, OdometryIsTheMotionInTheFrameBefore) {
  const FolderFixture fixture;
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.info(1).motion->mean, (Pose{1, 0, 0.5}));
  const Pose second = folder.info(2).motion->mean;
  EXPECT_NEAR(second.x, 2 * std::sin(0.5), 1e-15);
  EXPECT_NEAR(second.y, 2 * std::cos(0.5), 1e-15);
  EXPECT_EQ(second.theta, 0.0);
}

TEST(ImageFolder, EurocFilesAreRead) {
  FolderFixture fixture;
  fixture.files["cam0/sensor.yaml"] =
      "# General sensor definitions.\r\nsensor_type: camera\ncomment: VI-Sensor cam0\n\n"
      "T_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, -0.99, 0.02, -0.02,\n         0, 0, 0, 1]\n"
      "rate_hz: 20\nresolution: [8, 6]\ncamera_model: pinhole\n"
      "intrinsics: [458.654, 457.296, 3.2, 2.4] #fu, fv, cu, cv\n"
      "distortion_model: radial-tangential\n"
      "distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n";
  fixture.files["cam0/data.csv"] =
      "#timestamp [ns],filename\r\n1403636579763555584,a.png\r\n1403636579813555456,b.png\r\n";
  fixture.files["altimeter0/data.csv"] = "1403636579763555584,2\n1403636579813555456,2\n";
  fixture.files["state_groundtruth_estimate0/data.csv"] =
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z [], v_RS_R_x [m s^-1]\n"
      "1403636579763555584,4.688319,-1.786938,0.783338,0.8660254037844387,0,0,0.5,-0.027876\n";
  fixture.files.erase("odometry0/data.csv");
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.camera().model().distortion,
            (std::array<double, 8>{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}));
  EXPECT_EQ(folder.info(1).time_ns, 1403636579813555456);
  EXPECT_FALSE(folder.has_odometry());
  EXPECT_FALSE(folder.info(1).motion.has_value());
  // The second frame lies beyond the ground truth's span.
  EXPECT_NEAR(folder.info(0).ground_truth->theta, 2 * std::asin(0.5), 1e-12);
  EXPECT_FALSE(folder.info(1).ground_truth.has_value());
  EXPECT_FALSE(folder.has_ground_truth());
}

TEST(ImageFolder, AnAltimeterMayStateItsPrecision) {
  FolderFixture fixture;
  const ImageFolder silent(fixture.write());
  EXPECT_EQ(silent.info(1).altitude_sigma_m, 0.0);
  EXPECT_EQ(silent.remarks(), std::vector<std::string>{});
  fixture.files["altimeter0/sensor.yaml"] =
      "sensor_type: altimeter\nsigma_absolute: 0.03\nsigma_relative: 0.02 # of the altitude\n";
  const ImageFolder folder(fixture.write());
  for (std::size_t i = 0; i < folder.size(); ++i) {  // at 2, 2.5 and 3 m
    const double relative_m = 0.02 * (2.0 + 0.5 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(folder.info(i).altitude_sigma_m,
                     std::sqrt(0.03 * 0.03 + relative_m * relative_m));
  }
  EXPECT_EQ(folder.remarks(), std::vector<std::string>{});
}

// A misspelt precision would count as none; what EuRoC's files say is not read either.
TEST(ImageFolder, KeysOfASensorThatNobodyReadsAreNamed) {
  FolderFixture fixture;
  fixture.files["altimeter0/sensor.yaml"] =
      "sensor_type: altimeter\ncomment: none\nrate_hz: 10\nT_BS: {rows: 4}\n"
      "sigma_realtive: 0.02\n";
  fixture.files["odometry0/sensor.yaml"] = "# none\nsigma: 1\n";
  // EuRoC says of its own cameras where they are.
  fixture.files["cam0/sensor.yaml"] +=
      "T_BS: {cols: 4, rows: 4, data: [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}\n"
      "mirored: true\n";
  const std::vector<std::string> remarks = ImageFolder(fixture.write()).remarks();
  ASSERT_EQ(remarks.size(), 4U);
  EXPECT_NE(remarks[1].find("cam0/sensor.yaml:6: T_BS is not read: the camera is taken to be at"),
            std::string::npos)
      << remarks[1];
  EXPECT_TRUE(remarks[2].ends_with("did you mean 'mirrored'?")) << remarks[2];
  EXPECT_TRUE(remarks[0].ends_with(
      "altimeter0/sensor.yaml:5: 'sigma_realtive' is not read; of altimeter0 known are "
      "outliers, scale, sigma_absolute, sigma_relative, time_offset_s; did you mean "
      "'sigma_relative'?"))
      << remarks[0];
  EXPECT_TRUE(
      remarks[3].ends_with("odometry0/sensor.yaml:2: 'sigma' is not read; of odometry0 known are "
                           "convention, heading_unit, outliers, scale, time_offset_s"))
      << remarks[3];
  fixture.files["cam0/sensor.yaml"] += "mounting: {x: 0.5}\n";
  EXPECT_EQ(ImageFolder(fixture.write()).remarks().size(), 3U);
}

// Honest rows of another order, without a header that says so.
TEST(ImageFolder, GroundTruthOfAnotherQuaternionOrderIsRefused) {
  FolderFixture fixture;
  std::string rows;
  for (int i = 0; i < 10; ++i) {
    const double half_rad = 0.2 * i;
    rows += std::to_string(250 * i) + "," + std::to_string(std::cos(half_rad)) + "," +
            std::to_string(std::sin(half_rad)) + ",0,0,0," + std::to_string(std::sin(half_rad)) +
            "," + std::to_string(std::cos(half_rad)) + "\n";
  }
  fixture.files["state_groundtruth_estimate0/data.csv"] = rows;
  const std::string refusal =
      test::input_error_of([&] { const ImageFolder folder(fixture.write()); });
  EXPECT_NE(refusal.find("data.csv: its quaternions look like qx qy qz qw"), std::string::npos)
      << refusal;
}

TEST(ImageFolder, GroundTruthIsOptional) {
  FolderFixture fixture;
  fixture.files.erase("state_groundtruth_estimate0/data.csv");
  const ImageFolder folder(fixture.write());
  EXPECT_FALSE(folder.has_ground_truth());
  EXPECT_TRUE(folder.has_odometry());
}

TEST(ImageFolder, ColourIsTurnedToGrey) {
  const FolderFixture fixture;
  fixture.write();
  test::write_picture(fixture.mav0() / "cam0/data/b.png",
                      cv::Mat(6, 8, CV_8UC3, cv::Scalar(10, 200, 90)));
  const cv::Mat picture = ImageFolder(fixture.mav0()).image(1);
  EXPECT_EQ(picture.type(), CV_8UC1);
  // ITU-R BT.601 luma, from blue, green, red.
  EXPECT_NEAR(picture.at<uchar>(3, 3), 0.114 * 10 + 0.587 * 200 + 0.299 * 90, 1.0);
}

TEST(ImageFolderRealData, KitePicturesAreRead) {
  FATHOM_REQUIRE_DATA("copr");
  const ImageFolder folder(test::data_path("copr"));
  ASSERT_EQ(folder.size(), 38U);
  EXPECT_TRUE(folder.has_odometry());
  EXPECT_TRUE(folder.has_ground_truth());
  EXPECT_EQ(folder.camera().model().width, 1068);
  EXPECT_EQ(folder.info(1).time_ns, 2'000'000'000);
  EXPECT_EQ(folder.info(1).altitude_m, 18.1456);
  EXPECT_EQ(folder.info(1).motion->mean, (Pose{-2.582860, 1.397785, -0.02063978}));
  EXPECT_EQ(folder.info(1).motion->covariance(2, 2), 1.903859e-03);
  EXPECT_EQ(folder.image(37).size(), cv::Size(1068, 712));
}

}  // namespace
}  // namespace fathom
