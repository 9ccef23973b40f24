// Registrations in which nothing moves: a vehicle at rest, or something in view of the camera.

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "vision/sea_floor.hpp"
#include "vision/small_model.hpp"

namespace fathom {
namespace {

using testing::HasSubstr;

const Camera& still_camera() {
  static const Camera made(test::small_model());
  return made;
}

cv::Mat noisy_picture(const Pose& pose, double noise_sigma, std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat noise(300, 400, CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0.0, noise_sigma);
  cv::Mat sum;
  test::sea_floor().seen(still_camera(), pose, 1.2).convertTo(sum, CV_32F);
  sum += noise;
  cv::Mat picture;
  sum.convertTo(picture, CV_8U);
  return picture;
}

// A part of the vehicle over the lowest fifth.
cv::Mat with_skid(cv::Mat picture) {
  cv::RNG random(9);
  cv::Mat small(15, 80, CV_8U);
  random.fill(small, cv::RNG::UNIFORM, 30, 220);
  cv::Mat skid;
  cv::resize(small, skid, {400, 60}, 0, 0, cv::INTER_NEAREST);
  skid.copyTo(picture.rowRange(240, 300));
  return picture;
}

FloorFeatures still_features(const cv::Mat& picture, const cv::Mat& mask = {},
                             double altitude_m = 1.2) {
  return on_floor(FeatureExtractor().extract(picture, mask), still_camera(), altitude_m);
}

TEST(Stationary, AVehicleAtRestIsFound) {
  for (const double sigma : {0.0, 3.0, 10.0}) {
    const Registration found = register_pair(still_features(noisy_picture({}, sigma, 1)),
                                             still_features(noisy_picture({}, sigma, 2)), {}, 1);
    EXPECT_TRUE(found.found) << found.reason;
    EXPECT_NEAR(found.motion.position().norm(), 0.0, 1e-3);
  }
}

// With the scale of one of them, the matches that agree are those about the middle of the picture.
TEST(Stationary, AVehicleAtRestIsFoundWhereAnAltitudeIsWrong) {
  RegistrationOptions options;
  for (const double wrong : {1.04, 1.05, 1.08}) {
    options.covariance.altitude_sigma_m = (wrong - 1.0) * 1.2;
    const Registration found =
        register_pair(still_features(noisy_picture({}, 3.0, 1)),
                      still_features(noisy_picture({}, 3.0, 2), {}, wrong * 1.2), options, 1);
    ASSERT_TRUE(found.found) << wrong << ": " << found.reason;
    EXPECT_NEAR(found.evidence.scale, 1.0 / wrong, 0.02);
    // The middle of the matches that agree is theirs, so an altitude is an error of place.
    const Eigen::Vector3d error = found.motion.vector();
    EXPECT_LT(error.dot(found.covariance.ldlt().solve(error)), 14.2);  // 3 degrees, 0.997
  }
}

TEST(Stationary, APartOfTheVehicleIsNoRival) {
  const Pose motion{0.3, 0.1, 0.2};
  const FloorFeatures from = still_features(with_skid(noisy_picture({}, 2.0, 1)));
  const FloorFeatures to = still_features(with_skid(noisy_picture(motion, 2.0, 2)));
  const Registration found = register_pair(from, to, {}, 1);
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_NEAR((found.motion.position() - motion.position()).norm(), 0.0, 5e-3);
}

// No floor in common: what agrees is the skid alone.
TEST(Stationary, APartOfTheVehicleIsNoMotion) {
  const FloorFeatures from = still_features(with_skid(noisy_picture({}, 2.0, 1)));
  const FloorFeatures to = still_features(with_skid(noisy_picture({1.5, 1.2, 0.5}, 2.0, 2)));
  for (const auto method :
       {DecisionOptions::Method::false_alarms, DecisionOptions::Method::inliers}) {
    RegistrationOptions options;
    options.decision.method = method;
    const Registration refused = register_pair(from, to, options, 1);
    EXPECT_FALSE(refused.found);
    EXPECT_THAT(refused.reason, HasSubstr("of 64 parts of the picture: something in view"));
    EXPECT_EQ(refused.covariance, Eigen::Matrix3d::Zero());
  }
}

TEST(Stationary, WithAMaskTheFloorIsRegistered) {
  cv::Mat mask(300, 400, CV_8U, cv::Scalar(255));
  mask.rowRange(240, 300).setTo(0);
  const Pose motion{0.15, 0.1, 0.1};
  const Registration found =
      register_pair(still_features(with_skid(noisy_picture({}, 2.0, 1)), mask),
                    still_features(with_skid(noisy_picture(motion, 2.0, 2)), mask), {}, 1);
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_NEAR(found.motion.x, motion.x, 2e-3);
  EXPECT_NEAR(found.motion.y, motion.y, 2e-3);
  EXPECT_NEAR(found.motion.theta, motion.theta, 2e-3);
}

TEST(Stationary, AMotionOfSomePixelsIsNoRest) {
  const Pose motion{0.02, 0.0, 0.0};  // 6 pixels
  const Registration found = register_pair(still_features(noisy_picture({}, 2.0, 1)),
                                           still_features(noisy_picture(motion, 2.0, 2)), {}, 1);
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_NEAR(found.motion.x, motion.x, 1e-3);
}

}  // namespace
}  // namespace fathom
