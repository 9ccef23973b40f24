#include "fathom/datasets/noisy_odometry.hpp"

#include <cmath>
#include <cstring>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "small_survey.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

Eigen::Matrix3d noise_covariance() {
  Eigen::Matrix3d C;
  C << 4e-4, 1e-4, -5e-5,  //
      1e-4, 2e-4, 3e-5,    //
      -5e-5, 3e-5, 1e-4;
  return C;
}

SimulatedSurvey many_frames() {
  SimulatedSurveyOptions options = test::full_survey();
  options.mission.frame_rate_hz = 200.0;
  return SimulatedSurvey(options, 11);
}

TEST(NoisyOdometry, WithoutNoiseIsTheRecordedBitForBit) {
  const SimulatedSurvey survey(test::full_survey(), 3);
  const NoisyOdometry same(survey, {});
  ASSERT_EQ(same.size(), survey.size());
  for (std::size_t i = 1; i < survey.size(); ++i) {
    EXPECT_EQ(std::memcmp(&same.info(i).motion->mean, &survey.info(i).motion->mean, sizeof(Pose)),
              0);
    EXPECT_EQ(same.info(i).motion->covariance, survey.info(i).motion->covariance);
  }
}

TEST(NoisyOdometry, LeavesTheRestOfAFrameAsItIs) {
  const SimulatedSurvey survey(test::full_survey(), 3);
  const NoisyOdometry noisy(survey, {noise_covariance(), 1, 0});
  EXPECT_TRUE(noisy.has_odometry());
  EXPECT_TRUE(noisy.has_ground_truth());
  EXPECT_FALSE(noisy.is_visual_odometry());
  EXPECT_FALSE(noisy.info(0).motion);
  for (std::size_t i = 0; i < survey.size(); ++i) {
    EXPECT_EQ(noisy.info(i).time_ns, survey.info(i).time_ns);
    EXPECT_EQ(noisy.info(i).altitude_m, survey.info(i).altitude_m);
    EXPECT_EQ(noisy.info(i).ground_truth, survey.info(i).ground_truth);
    EXPECT_EQ(noisy.picture_id(i), survey.picture_id(i));
  }
  EXPECT_EQ(cv::norm(noisy.image(2), survey.image(2), cv::NORM_INF), 0.0);
}

TEST(NoisyOdometry, TheDrawsHaveTheirCovarianceAndItIsAdded) {
  const SimulatedSurvey survey = many_frames();
  const NoisyOdometry noisy(survey, {noise_covariance(), 7, 2});
  const auto steps = static_cast<double>(survey.size() - 1);
  ASSERT_GT(steps, 2500);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::size_t i = 1; i < survey.size(); ++i) {
    const UncertainPose& before = *survey.info(i).motion;
    const UncertainPose& after = *noisy.info(i).motion;
    const Eigen::Vector3d e = after.mean.vector() - before.mean.vector();
    sum += e;
    squares += e * e.transpose();
    EXPECT_LT((after.covariance - before.covariance - noise_covariance()).cwiseAbs().maxCoeff(),
              1e-18);
  }
  const Eigen::Matrix3d C = noise_covariance();
  // Each within five standard deviations of its estimate.
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i] / steps, 0.0, 5 * std::sqrt(C(i, i) / steps));
    for (int j = 0; j < 3; ++j) {
      const double deviation = std::sqrt((C(i, i) * C(j, j) + C(i, j) * C(i, j)) / steps);
      EXPECT_NEAR(squares(i, j) / steps, C(i, j), 5 * deviation) << i << ' ' << j;
    }
  }
}

TEST(NoisyOdometry, TheDrawsAreThoseOfTheStream) {
  const SimulatedSurvey survey(test::full_survey(), 3);
  const NoisyOdometry noisy(survey, {noise_covariance(), 7, 2});
  RandomStream stream(7, "added_noise", 2);
  const MotionNoise draws(noise_covariance());
  for (std::size_t i = 1; i < survey.size(); ++i) {
    const Eigen::Vector3d expected = survey.info(i).motion->mean.vector() + draws.draw(stream);
    EXPECT_LT((noisy.info(i).motion->mean.vector() - expected).norm(), 1e-15) << i;
  }
  const NoisyOdometry other(survey, {noise_covariance(), 7, 3});
  EXPECT_NE(other.info(1).motion->mean, noisy.info(1).motion->mean);
}

TEST(NoisyOdometry, ANoisyHeadingIsWrapped) {
  const SimulatedSurvey survey = many_frames();
  const Eigen::Matrix3d wild = Eigen::Vector3d(1e-4, 1e-4, 9.0).asDiagonal();
  const NoisyOdometry noisy(survey, {wild, 1, 0});
  double largest = 0.0;
  for (std::size_t i = 1; i < noisy.size(); ++i) {
    const double theta = std::abs(noisy.info(i).motion->mean.theta);
    EXPECT_LE(theta, std::numbers::pi);
    largest = std::max(largest, theta);
  }
  EXPECT_GT(largest, 2.0);
}

TEST(AddedNoiseOptions, AreAllOrNothing) {
  AddedNoiseOptions options;
  EXPECT_TRUE(options.noise_covariance("").isZero(0.0));
  const auto refused = [&] {
    return test::input_error_of([&] { options.noise_covariance("n."); });
  };
  options.sigma_x_m = 0.1;
  options.sigma_theta_rad = 0.3;
  EXPECT_EQ(refused().find("n.sigma_y_m: "), 0U);
  options.sigma_y_m = 0.2;
  EXPECT_TRUE(options.noise_covariance("").isApprox(
      Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal().toDenseMatrix(), 1e-15));
  options.covariance = {4e-4, 1e-4, -5e-5, 2e-4, 3e-5, 1e-4};  // wins
  EXPECT_EQ(options.noise_covariance(""), noise_covariance());
  options.covariance = {1, 1, 0, 1, 0, 1};
  EXPECT_EQ(refused().find("n.covariance: is not positive definite"), 0U);
  options.covariance = {0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(options.noise_covariance("").isZero(0.0));
}

}  // namespace
}  // namespace fathom
