#include "fathom/vision/registration.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "src/vision/motion_covariance.hpp"
#include "src/vision/rigid_motion.hpp"
#include "vision/labelled.hpp"
#include "vision/sea_floor.hpp"
#include "vision/small_model.hpp"

namespace fathom {
namespace {

using test::labelled;
using test::sea_floor;
using ::testing::HasSubstr;

// Forty centimetres of mounting offset and a yaw: a wrong sign anywhere shows.
CameraModel mounted() {
  CameraModel model = test::small_model();
  model.mount_x_m = 0.4;
  model.mount_yaw_rad = 0.6;
  return model;
}

FloorFeatures features_at(const Pose& pose, double altitude_m, const std::string& type = "sift",
                          const Camera& camera = Camera(mounted())) {
  FeatureOptions options;
  options.type = type;
  return on_floor(FeatureExtractor(options).extract(sea_floor().seen(camera, pose, altitude_m)),
                  camera, altitude_m);
}

void expect_motion(const Registration& result, const Pose& motion, double tolerance_m) {
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_NEAR(result.motion.x, motion.x, tolerance_m);
  EXPECT_NEAR(result.motion.y, motion.y, tolerance_m);
  EXPECT_NEAR(wrap_angle(result.motion.theta - motion.theta), 0.0, tolerance_m);
  EXPECT_TRUE(is_positive_definite(result.covariance));
  EXPECT_TRUE(result.reason.empty());
}

TEST(RegisterPair, FindsTheMotionBetweenTwoPictures) {
  const Pose A{0.1, -0.2, 0.3};
  for (const Pose& B : {Pose{0.3, -0.1, 0.5}, Pose{0.0, 0.1, -2.8}, A}) {
    const Registration result = register_pair(features_at(A, 1.5), features_at(B, 1.5), {}, 1);
    expect_motion(result, between(A, B), 0.004);
  }
}

TEST(RegisterPair, AccountsForTheAltitudeOfEachPicture) {
  const Pose A{0.1, -0.2, 0.3};
  const Pose B{0.2, 0.0, 1.0};
  expect_motion(register_pair(features_at(A, 1.3), features_at(B, 2.1), {}, 1), between(A, B),
                0.006);
}

TEST(RegisterPair, UndoesTheDistortionOfTheLens) {
  CameraModel model = mounted();
  model.distortion = {-0.25, 0.05, 0.001, -0.0005, 0.0};
  const Pose B{0.1, 0.15, 2.0};
  const FloorFeatures a = features_at({}, 1.5, "sift", Camera(model));
  const FloorFeatures b = features_at(B, 1.5, "sift", Camera(model));
  const Registration result = register_pair(a, b, {}, 1);
  expect_motion(result, B, 0.004);
  EXPECT_LT(result.rms_m, 0.006);
}

TEST(RegisterPair, OfTheSwappedPairIsTheInverse) {
  const FloorFeatures a = features_at({0.0, 0.0, 0.0}, 1.5);
  const FloorFeatures b = features_at({0.25, 0.1, 0.7}, 1.6);
  const Registration forward = register_pair(a, b, {}, 1);
  const Registration backward = register_pair(b, a, {}, 1);
  expect_motion(backward, inverse(forward.motion), 0.003);
}

TEST(RegisterPair, WorksWithEveryDetector) {
  const Pose B{0.15, 0.05, 0.2};
  for (const DetectorEntry& detector : detectors()) {
    SCOPED_TRACE(detector.name);
    expect_motion(register_pair(features_at({}, 1.5, detector.name),
                                features_at(B, 1.5, detector.name), {}, 1),
                  B, 0.01);
  }
}

TEST(RegisterPair, SaysThatPicturesDoNotOverlap) {
  const FloorFeatures a = features_at({-1.3, -1.2, 0.0}, 1.2);
  const FloorFeatures b = features_at({1.0, 1.2, 0.4}, 1.2);
  ASSERT_GT(a.size(), 300U);
  ASSERT_GT(b.size(), 300U);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Registration result = register_pair(a, b, {}, seed);
    EXPECT_FALSE(result.found);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_LE(result.evidence.support, 40);
  }
}

TEST(RegisterPair, SaysWhyThereIsNoMotionInNumbers) {
  const FloorFeatures a = features_at({}, 1.5);
  RegistrationOptions options;
  options.ransac.max_error_m = 0.03;
  options.covariance.floor_sigma_m = 1e-5;
  EXPECT_EQ(register_pair({}, {}, options, 1).reason, "0 matches, 12 are needed");
  options.ransac.min_places = 1000;
  options.ransac.iterations = 20;
  EXPECT_THAT(register_pair(a, a, options, 1).reason, HasSubstr("places, 1000 are needed"));
}

TEST(RegisterPair, SeveralKeypointsAtOnePlaceAreOneMatch) {
  RandomStream random(9);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 20; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    points.emplace_back(x, random.uniform(-1.0, 1.0));
  }
  std::vector<Eigen::Vector2d> repeated = points;
  repeated.insert(repeated.end(), points.begin(), points.end());
  const Registration once = register_pair(labelled(points), labelled(points), {}, 1);
  const Registration twice = register_pair(labelled(repeated), labelled(repeated), {}, 1);
  ASSERT_TRUE(once.found);
  ASSERT_TRUE(twice.found);
  EXPECT_EQ(twice.putative, once.putative);
  EXPECT_EQ(twice.inliers.size(), 20U);
}

TEST(RegisterPair, AddsTheFloorToTheResidualsCovariance) {
  RandomStream random(10);
  std::vector<Eigen::Vector2d> q;
  std::vector<Eigen::Vector2d> p;
  const Pose z{0.3, 0.4, 0.5};
  for (int i = 0; i < 40; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    q.emplace_back(x, random.uniform(-1.0, 1.0));
    const double dx = 0.002 * random.normal();
    const double dy = 0.002 * random.normal();
    p.push_back(transform(z, q.back()) + Eigen::Vector2d(dx, dy));
  }
  RegistrationOptions options;
  options.covariance.altitude_sigma_m = 0.0;
  options.covariance.tilt_sigma_rad = 0.0;
  options.covariance.floor_sigma_m = 0.1;
  options.covariance.floor_sigma_rad = 0.02;
  const Registration result = register_pair(labelled(p), labelled(q), options, 1);
  ASSERT_TRUE(result.found);
  ASSERT_EQ(result.inliers.size(), 40U);
  // Forty errors may look a little clustered.
  const std::vector<double> weights(40, 1.0);
  const LinearFit fit(result.motion, p, q, weights);
  Eigen::Matrix3d expected = fit.covariance() * fit.clustering(64.0 * test::kMetresPerPixel, 6);
  expected += shared_error(result.rms_m, 0.055);
  expected += Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal();
  EXPECT_LT((result.covariance - expected).norm(), 1e-12);
  // Exact points leave the floor alone, and that is positive definite.
  const Registration exact = register_pair(labelled(q), labelled(q), options, 1);
  EXPECT_TRUE(is_positive_definite(exact.covariance));
}

TEST(RegisterPair, ItsCovarianceIsHonestUnderWrongMatches) {
  // Noisy points, a third of the matches wrong: the whole of matching, RANSAC and covariance.
  constexpr int kTrials = 400;
  const Pose truth{0.5, -0.3, 0.8};
  RegistrationOptions options;
  options.ransac.iterations = 100;
  options.covariance.tilt_sigma_rad = 0.0;
  options.covariance.floor_sigma_m = 1e-6;
  options.covariance.floor_sigma_rad = 1e-6;
  RandomStream random(11);
  double nis = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Eigen::Vector2d> p;
    std::vector<Eigen::Vector2d> q;
    for (int i = 0; i < 90; ++i) {
      const double x = random.uniform(0.5, 2.5);
      q.emplace_back(x, random.uniform(-1.0, 1.0));
      const double sigma_m = i % 3 == 0 ? 1.0 : 0.008;
      const double dx = sigma_m * random.normal();
      const double dy = sigma_m * random.normal();
      p.push_back(transform(truth, q.back()) + Eigen::Vector2d(dx, dy));
    }
    const Registration result =
        register_pair(labelled(p), labelled(q), options, static_cast<std::uint64_t>(trial));
    ASSERT_TRUE(result.found);
    const Eigen::Vector3d nu(result.motion.x - truth.x, result.motion.y - truth.y,
                             wrap_angle(result.motion.theta - truth.theta));
    nis += nu.dot(result.covariance.ldlt().solve(nu)) / kTrials;
  }
  // 99.9 % of the means of 400 lie within 3.29 √(6/400) = 0.40 of 3 (117/115 more: σ² is
  // estimated).
  EXPECT_NEAR(nis, 3.05, 0.40);
}

TEST(RegisterPair, PointsThatAreNoNumbersMatchNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Eigen::Vector2d> points(40, Eigen::Vector2d(nan, nan));
  const Registration result = register_pair(labelled(points), labelled(points), {}, 1);
  EXPECT_FALSE(result.found);
  EXPECT_EQ(result.reason, "0 matches, 12 are needed");
}

TEST(RegisterPair, RefusesFeaturesWithoutPoints) {
  FloorFeatures broken = labelled({{0.0, 0.0}, {1.0, 1.0}});
  broken.points.pop_back();
  EXPECT_THROW(register_pair(broken, broken, {}, 1), InputError);
}

TEST(RegistrationOptions, HaveTheKeysOfTheConfiguration) {
  RegistrationOptions options;
  OptionTable table;
  options.describe(table);
  for (const char* key :
       {"matching.ratio", "matching.mutual", "ransac.iterations", "ransac.sample_size",
        "ransac.max_error_m", "ransac.min_inliers", "ransac.min_places", "ransac.score",
        "decision.method", "decision.max_false_alarms", "covariance.altitude_sigma_m",
        "covariance.tilt_sigma_rad", "covariance.floor_sigma_m", "covariance.floor_sigma_rad"}) {
    EXPECT_TRUE(table.has(key)) << key;
  }
  EXPECT_THROW(table.set("covariance.floor_sigma_m", OptionValue::scalar("0")), InputError);
}

}  // namespace
}  // namespace fathom
