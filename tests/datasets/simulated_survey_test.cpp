#include "src/datasets/simulated/simulated_survey.hpp"

#include <cmath>
#include <numbers>
#include <thread>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "same_picture.hpp"
#include "small_survey.hpp"
#include "src/datasets/simulated/sea_floor.hpp"
#include "support/data.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::full_survey;
using test::same;
using test::small_survey;

TEST(SimulatedSurvey, IsAFrameSourceOfItsMission) {
  const SimulatedSurvey survey(small_survey(), 1);
  const auto truth = fly_mission(small_survey().mission, "");
  ASSERT_EQ(survey.size(), truth.size());
  EXPECT_TRUE(survey.has_odometry());
  EXPECT_TRUE(survey.has_ground_truth());
  EXPECT_FALSE(survey.info(0).motion.has_value());
  for (std::size_t i = 0; i < survey.size(); ++i) {
    EXPECT_EQ(survey.info(i).time_ns, truth[i].time_ns);
    EXPECT_EQ(*survey.info(i).ground_truth, truth[i].pose);
    if (i > 0) {
      EXPECT_TRUE(survey.info(i).motion.has_value());
    }
  }
  const cv::Mat picture = survey.image(3);
  EXPECT_EQ(picture.size(), cv::Size(64, 48));
  EXPECT_EQ(picture.type(), CV_8UC1);
}

TEST(SimulatedSurvey, PrincipalPointDefaultsToTheMiddle) {
  const SimulatedSurvey survey(small_survey(), 1);
  EXPECT_EQ(survey.camera().model().cx, 31.5);
  EXPECT_EQ(survey.camera().model().cy, 23.5);
}

TEST(SimulatedSurvey, SameSeedSameEverything) {
  const SimulatedSurvey a(full_survey(), 9, 2);
  const SimulatedSurvey b(full_survey(), 9, 2);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.info(i).altitude_m, b.info(i).altitude_m);
    if (i > 0) {
      EXPECT_EQ(a.info(i).motion->mean, b.info(i).motion->mean);
    }
    EXPECT_TRUE(same(a.image(i), b.image(i)));
  }
}

TEST(SimulatedSurvey, AnotherTrialHasOtherMotionsOverTheSameFloorAndAltitudes) {
  const SimulatedSurvey a(full_survey(), 9, 0);
  const SimulatedSurvey b(full_survey(), 9, 1);
  EXPECT_EQ(a.info(1).altitude_m, b.info(1).altitude_m);
  EXPECT_NE(a.info(1).motion->mean, b.info(1).motion->mean);
  EXPECT_TRUE(same(a.image(1), b.image(1)));
}

TEST(SimulatedSurvey, AnotherSeedHasAnotherFloor) {
  EXPECT_FALSE(same(SimulatedSurvey(small_survey(), 1).image(0),
                    SimulatedSurvey(small_survey(), 2).image(0)));
}

// A stream must not shift when another takes more or fewer draws.
TEST(SimulatedSurvey, NoiseStreamsAreIndependent) {
  SimulatedSurveyOptions exact_altimeter = full_survey();
  exact_altimeter.altitude.altimeter_sigma_m = 0.0;
  const SimulatedSurvey a(full_survey(), 4);
  const SimulatedSurvey b(exact_altimeter, 4);
  SimulatedSurveyOptions other_odometry = full_survey();
  other_odometry.odometry.source = OdometrySource::kVisualOdometry;
  const SimulatedSurvey c(other_odometry, 4);
  for (std::size_t i = 1; i < a.size(); ++i) {
    EXPECT_EQ(a.info(i).motion->mean, b.info(i).motion->mean);
    EXPECT_EQ(b.info(i).altitude_m, b.true_altitude_m(i));
    EXPECT_EQ(a.info(i).altitude_m, c.info(i).altitude_m);
  }
}

TEST(SimulatedSurvey, NoiseHasTheStatedCovariance) {
  SimulatedSurveyOptions options = full_survey();
  options.mission.frame_rate_hz = 200.0;
  const SimulatedSurvey survey(options, 11);
  double chi2 = 0.0;
  double altimeter_chi2 = 0.0;
  const auto steps = static_cast<double>(survey.size() - 1);
  for (std::size_t i = 1; i < survey.size(); ++i) {
    const Eigen::Vector3d truth =
        test::t2v(test::homogeneous(*survey.info(i - 1).ground_truth).inverse() *
                  test::homogeneous(*survey.info(i).ground_truth));
    Eigen::Vector3d e = survey.info(i).motion->mean.vector() - truth;
    e.z() = test::angle_between(e.z(), 0.0);
    chi2 += e.dot(survey.info(i).motion->covariance.inverse() * e);
    const double z = (survey.info(i).altitude_m - survey.true_altitude_m(i)) / 0.01;
    altimeter_chi2 += z * z;
  }
  EXPECT_GT(steps, 2500);
  EXPECT_NEAR(chi2, 3 * steps, 4 * std::sqrt(6 * steps));
  EXPECT_NEAR(altimeter_chi2, steps, 4 * std::sqrt(2 * steps));
}

// Two streams of one seed would begin with the same draw.
TEST(SimulatedSurvey, AltimeterAndOdometryDoNotShareTheirDraws) {
  const SimulatedSurvey survey(small_survey(), 8);
  const double step_m = 0.25;
  const double first_of_odometry = (survey.info(1).motion->mean.x - step_m) / 0.01;
  const double first_of_altimeter = (survey.info(0).altitude_m - 2.0) / 0.01;
  EXPECT_LT(std::abs(first_of_odometry), 5.0);
  EXPECT_GT(std::abs(first_of_odometry - first_of_altimeter), 1e-6);
}

TEST(SimulatedSurvey, AltitudeIsASineOverTime) {
  SimulatedSurveyOptions options = small_survey();
  options.altitude = {3.0, 0.5, 8.0, 0.0};
  const SimulatedSurvey survey(options, 1);
  EXPECT_NEAR(survey.info(0).altitude_m, 3.0, 1e-12);
  EXPECT_NEAR(survey.info(4).altitude_m, 3.5, 1e-12);  // 2 s: a quarter of the period
  EXPECT_NEAR(survey.info(12).altitude_m, 2.5, 1e-12);
}

TEST(SimulatedSurvey, LeavesMotionsToVisualOdometry) {
  SimulatedSurveyOptions options = small_survey();
  options.odometry.source = OdometrySource::kVisualOdometry;
  const SimulatedSurvey survey(options, 1);
  EXPECT_FALSE(survey.has_odometry());
  for (std::size_t i = 0; i < survey.size(); ++i) EXPECT_FALSE(survey.info(i).motion.has_value());
}

TEST(SimulatedSurvey, PicturesMayBeMadeByManyThreads) {
  const SimulatedSurvey survey(full_survey(), 5);
  std::vector<cv::Mat> pictures(survey.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < survey.size(); i += 4) pictures[i] = survey.image(i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < survey.size(); ++i) EXPECT_TRUE(same(pictures[i], survey.image(i)));
}

TEST(SimulatedSurvey, FliesOverAGivenPicture) {
  FATHOM_REQUIRE_DATA("worlds/dunes.jpg");
  SimulatedSurveyOptions options;
  options.world.picture = test::data_path("worlds/dunes.jpg").string();
  options.mission.leg_length_m = 6.0;
  options.mission.legs = 2;
  const SimulatedSurvey survey(options, 1);
  // 4272 × 2848 pixels of 4 mm, those of the camera are 4 mm: once twice as fine.
  EXPECT_EQ(survey.world().picture.size(), cv::Size(8544, 5696));
  std::vector<cv::KeyPoint> keypoints;
  cv::SIFT::create()->detect(survey.image(0), keypoints);
  EXPECT_GT(keypoints.size(), 100U);
}

// On a straight line the body moves ahead, in the last frame too.
TEST(SimulatedSurvey, BlursAlongItsMotionAndTiltsAsItSays) {
  SimulatedSurveyOptions options = test::small_survey();
  options.mission.type = MissionType::kWaypoints;
  options.mission.waypoints_m = {0, 0, 1, 0};
  options.effects.camera.motion_blur_px = 6.0;
  options.attitude.roll_sigma_rad = 0.05;
  const SimulatedSurvey survey(options, 4);
  const FloorRenderer renderer(survey.camera(), ViewRays(survey.camera()), survey.world());
  for (const std::size_t i : {std::size_t{0}, survey.size() - 1}) {
    EXPECT_NE(survey.true_tilt(i).roll_rad, 0.0);
    EXPECT_EQ(survey.true_tilt(i).pitch_rad, 0.0);
    View view{*survey.info(i).ground_truth, survey.true_altitude_m(i), survey.true_tilt(i)};
    EXPECT_TRUE(same(survey.image(i), renderer.render(view, options.effects))) << i;
    view.motion_rad = std::numbers::pi / 2.0;
    EXPECT_FALSE(same(survey.image(i), renderer.render(view, options.effects))) << i;
  }
}

TEST(SeaFloor, HasHundredsOfFeaturesEverywhere) {
  const cv::Mat floor = draw_sea_floor({1920, 1440}, 0.004, 21);
  const auto sift = cv::SIFT::create();
  for (int v = 0; v < floor.rows; v += 480) {
    for (int u = 0; u < floor.cols; u += 640) {
      std::vector<cv::KeyPoint> keypoints;
      sift->detect(floor(cv::Rect(u, v, 640, 480)), keypoints);
      EXPECT_GT(keypoints.size(), 500U) << u << ' ' << v;
    }
  }
}

TEST(SeaFloor, IsNeitherDarkNorBurntOut) {
  const cv::Mat floor = draw_sea_floor({1200, 1200}, 0.004, 3);
  EXPECT_LT(cv::countNonZero(floor < 10) + cv::countNonZero(floor > 245), 0.005 * 1200 * 1200);
  EXPECT_NEAR(cv::mean(floor)[0], 128, 30);
}

// The best agreement of a patch with any place far from its own stays well below one.
TEST(SeaFloor, DoesNotRepeat) {
  const cv::Mat floor = draw_sea_floor({1000, 1000}, 0.006, 8);
  cv::Mat agreement;
  cv::matchTemplate(floor, floor(cv::Rect(450, 450, 100, 100)), agreement, cv::TM_CCOEFF_NORMED);
  EXPECT_GT(agreement.at<float>(450, 450), 0.999F);
  agreement(cv::Rect(400, 400, 100, 100)) = 0.0F;
  double best = 0.0;
  cv::minMaxLoc(agreement, nullptr, &best);
  EXPECT_LT(best, 0.8);
}

TEST(SeaFloor, DoesNotDependOnTheNumberOfThreads) {
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Mat one = draw_sea_floor({300, 400}, 0.01, 6);
  cv::setNumThreads(2);
  const cv::Mat two = draw_sea_floor({300, 400}, 0.01, 6);
  cv::setNumThreads(threads);
  EXPECT_TRUE(same(one, two));
}

TEST(SeaFloor, OfAnySizeAndResolution) {
  EXPECT_EQ(draw_sea_floor({1, 1}, 0.004, 1).size(), cv::Size(1, 1));
  EXPECT_EQ(draw_sea_floor({7, 3}, 1000.0, 1).size(), cv::Size(7, 3));
  EXPECT_EQ(draw_sea_floor({40, 30}, 1e-5, 1).size(), cv::Size(40, 30));
}

}  // namespace
}  // namespace fathom
