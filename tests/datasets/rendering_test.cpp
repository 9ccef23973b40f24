// Pictures of a world of bright dots: the dots must lie where the camera model projects them to.

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "src/datasets/simulated/simulated_survey.hpp"
#include "support/pictures.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

constexpr double kMetresPerPixel = 0.005;
constexpr int kColumns = 1401;
constexpr int kRows = 1001;

// Dots 0.4 m apart, smooth so that their centroids are where they were put.
std::vector<Eigen::Vector2d> dots() {
  std::vector<Eigen::Vector2d> places;
  for (double x = -2.2; x < 2.3; x += 0.4) {
    for (double y = -3.2; y < 3.3; y += 0.4) places.emplace_back(x + 0.013 * y, y + 0.0021);
  }
  return places;
}

// x up, y left, origin in the middle: the stated convention, written out once more.
void write_world(const std::filesystem::path& file) {
  constexpr double kSigma = 3.0;
  cv::Mat_<double> world(kRows, kColumns, 10.0);
  for (const Eigen::Vector2d& dot : dots()) {
    const double column = 700.0 - dot.y() / kMetresPerPixel;
    const double row = 500.0 - dot.x() / kMetresPerPixel;
    for (int v = static_cast<int>(row) - 25; v < row + 25; ++v) {
      for (int u = static_cast<int>(column) - 25; u < column + 25; ++u) {
        const double r2 = (u - column) * (u - column) + (v - row) * (v - row);
        world(v, u) += 230.0 * std::exp(-r2 / (2 * kSigma * kSigma));
      }
    }
  }
  cv::Mat grey;
  world.convertTo(grey, CV_8U);
  ASSERT_TRUE(test::write_picture(file, grey));
}

Eigen::Vector2d centroid(const cv::Mat& picture, const Eigen::Vector2d& about) {
  constexpr int kReach = 14;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (int v = static_cast<int>(about.y()) - kReach; v <= about.y() + kReach; ++v) {
    for (int u = static_cast<int>(about.x()) - kReach; u <= about.x() + kReach; ++u) {
      const double grey = std::max(0.0, picture.at<uchar>(v, u) - 20.0);
      sum += grey * Eigen::Vector2d(u, v);
      weight += grey;
    }
  }
  return sum / weight;
}

struct SeenFrom {
  const char* name;
  double altitude_m;
  double heading_rad;  ///< of frame 0 in the picture
  bool full_camera;    ///< distortion and mounting
};

class Rendering : public testing::TestWithParam<SeenFrom> {
 protected:
  static SimulatedSurveyOptions options(const std::filesystem::path& world) {
    SimulatedSurveyOptions o;
    o.world.picture = world.string();
    o.world.metres_per_pixel = kMetresPerPixel;
    o.world.heading_rad = GetParam().heading_rad;
    o.world.origin_x_m = -0.1;
    o.world.origin_y_m = 0.2;
    o.mission.type = MissionType::kWaypoints;
    o.mission.waypoints_m = {0, 0, 0.3, 0, 0.3, -0.3};
    o.mission.turn_radius_m = 0.2;
    o.mission.speed_m_s = 0.25;
    o.altitude.base_m = GetParam().altitude_m;
    o.altitude.amplitude_m = 0.1;
    o.altitude.period_s = 3.0;
    o.camera.base.width = 400;
    o.camera.base.height = 300;
    o.camera.base.fx = 300;
    o.camera.base.fy = 310;
    if (GetParam().full_camera) {
      o.camera.cx = 190.5;
      o.camera.cy = 158.0;
      o.camera.distortion = {-0.18, 0.03, 0.002, -0.001, 0.0};
      o.camera.base.mount_x_m = 0.2;
      o.camera.base.mount_y_m = -0.1;
      o.camera.base.mount_yaw_rad = 0.7;
    }
    return o;
  }
};

TEST_P(Rendering, DotsLieWhereTheCameraProjectsThem) {
  const test::TemporaryFolder folder;
  write_world(folder / "dots.png");
  const SimulatedSurvey survey(options(folder / "dots.png"), 3);
  const Eigen::Matrix3d T_picture_mission = test::homogeneous({-0.1, 0.2, GetParam().heading_rad});
  int compared = 0;
  ASSERT_GE(survey.size(), 4U);
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const cv::Mat picture = survey.image(i);
    const Eigen::Matrix3d T_picture_body =
        T_picture_mission * test::homogeneous(*survey.info(i).ground_truth);
    for (const Eigen::Vector2d& dot : dots()) {
      const Eigen::Vector3d in_body = T_picture_body.inverse() * dot.homogeneous();
      const Eigen::Vector2d expected =
          survey.camera().pixel(in_body.head<2>(), survey.true_altitude_m(i));
      if (expected.x() < 16 || expected.y() < 16 || expected.x() > 383 || expected.y() > 283) {
        continue;
      }
      EXPECT_LT((centroid(picture, expected) - expected).norm(), 0.1)
          << "frame " << i << " at " << expected.transpose();
      ++compared;
    }
  }
  EXPECT_GT(compared, 60);
}

// The camera's pixels have 4.3 to 8.7 mm on the floor, those of the world 5 mm: it is doubled once.
INSTANTIATE_TEST_SUITE_P(
    Views, Rendering,
    testing::Values(SeenFrom{"Straight", 1.5, 0.0, false}, SeenFrom{"Turned", 1.5, 2.1, false},
                    SeenFrom{"TurnedBack", 1.3, -1.2, true}, SeenFrom{"FullCamera", 1.5, 0.0, true},
                    SeenFrom{"High", 2.6, 0.3, false}, SeenFrom{"HighFullCamera", 2.3, -0.2, true}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

// What lies ahead is at the top, what lies to port at the left: no mirror anywhere.
TEST(RenderingConvention, AheadIsUpAndPortIsLeft) {
  const test::TemporaryFolder folder;
  cv::Mat world(800, 800, CV_8UC1, cv::Scalar(50));
  world(cv::Rect(400 - 80 - 10, 400 - 10, 20, 20)) = 255;  // left of the middle
  world(cv::Rect(400 - 10, 400 - 60 - 10, 20, 20)) = 150;  // above the middle
  ASSERT_TRUE(test::write_picture(folder / "w.png", world));
  SimulatedSurveyOptions o;
  o.world.picture = (folder / "w.png").string();
  o.world.metres_per_pixel = 0.01;
  o.world.origin_x_m = 0.0;
  o.world.origin_y_m = 0.0;
  o.mission.type = MissionType::kWaypoints;
  o.mission.waypoints_m = {0, 0, 0.1, 0};
  const SimulatedSurvey survey(o, 1);
  const cv::Mat picture = survey.image(0);
  // One world pixel is 2.5 picture pixels at 2 m and f = 500.
  EXPECT_EQ(picture.at<uchar>(239, 319 - 200), 255);
  EXPECT_EQ(picture.at<uchar>(239 - 150, 319), 150);
  EXPECT_EQ(picture.at<uchar>(239, 319 + 200), 50);
  EXPECT_EQ(picture.at<uchar>(239 + 150, 319), 50);
}

// Stripes much finer than a pixel must fade to their mean; a point sample would show them as false
// broad ones.
TEST(RenderingConvention, FineStripesFadeInsteadOfAliasing) {
  const test::TemporaryFolder folder;
  cv::Mat world(2400, 2400, CV_8UC1);
  for (int row = 0; row < world.rows; ++row) world.row(row) = row % 3 == 0 ? 240 : 60;
  ASSERT_TRUE(test::write_picture(folder / "w.png", world));
  SimulatedSurveyOptions o;
  o.world.picture = (folder / "w.png").string();
  o.world.metres_per_pixel = 0.001;
  o.mission.type = MissionType::kWaypoints;
  o.mission.waypoints_m = {0, 0, 0.05, 0};
  o.camera.base.width = 100;
  o.camera.base.height = 100;
  o.camera.base.fx = 130;
  o.camera.base.fy = 130;
  o.altitude.base_m = 1.3;
  const cv::Mat picture = SimulatedSurvey(o, 1).image(0);
  for (int row = 0; row < picture.rows; ++row) {
    EXPECT_NEAR(picture.at<uchar>(row, 50), 120, 12) << row;
  }
}

}  // namespace
}  // namespace fathom
