// The strongest features are tried first: what that refuses is refused, and all else is as without.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/labelled.hpp"
#include "vision/points.hpp"
#include "vision/sea_floor.hpp"

namespace fathom {
namespace {

using test::seen_at;
using ::testing::HasSubstr;
using ::testing::Not;

RegistrationOptions first(std::optional<int> features) {
  RegistrationOptions options;
  options.decision.first_features = features;
  return options;
}

FloorFeatures seen_thrice_as_high() {
  FloorFeatures features = seen_at({});
  for (Eigen::Vector2d& point : features.points) point *= 3.0;
  for (double& size_m : features.sizes_m) size_m *= 3.0;
  features.viewpoint.metres_per_pixel *= 3.0;
  return features;
}

TEST(FirstFeatures, APairThatPassesIsRegisteredAsIfTheyWereNot) {
  const FloorFeatures a = seen_at({});
  for (const Pose& pose : {Pose{0.1, 0.2, 0.3}, Pose{-0.5, 0.3, 2.0}, Pose{0.6, -0.6, -1.0}}) {
    const FloorFeatures b = seen_at(pose);
    const Registration with = register_pair(a, b, first(150), 3);
    const Registration without = register_pair(a, b, first(std::nullopt), 3);
    ASSERT_TRUE(with.found) << with.reason;
    EXPECT_EQ(with.motion, without.motion);
    EXPECT_EQ(with.covariance, without.covariance);
    EXPECT_EQ(with.inliers, without.inliers);
    EXPECT_EQ(with.evidence.false_alarms, without.evidence.false_alarms);
  }
}

TEST(FirstFeatures, APairWithoutOverlapIsToldByThem) {
  const FloorFeatures a = seen_at({-1.3, -1.2, 0.0});
  const FloorFeatures b = seen_at({1.0, 1.2, 0.4});
  ASSERT_GT(a.size(), 300U);
  int told = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Registration with = register_pair(a, b, first(150), seed);
    EXPECT_FALSE(with.found);
    told += with.reason.find("of the 150 strongest features") == 0 ? 1 : 0;
    EXPECT_THAT(register_pair(a, b, first(std::nullopt), seed).reason,
                Not(HasSubstr("strongest features")));
  }
  EXPECT_GE(told, 8);
}

// The same floor, by an altitude that is three times the other.
TEST(FirstFeatures, AltitudesThatDisagreeWithTheSizesOfKeypointsAreNamed) {
  for (const std::optional<int> features : {std::optional(150), std::optional<int>()}) {
    const Registration refused =
        register_pair(seen_at({}), seen_thrice_as_high(), first(features), 1);
    EXPECT_FALSE(refused.found);
    EXPECT_THAT(refused.reason, HasSubstr("the altitudes disagree with the sizes of keypoints: "));
  }
}

// Of the strongest, a part of the vehicle: 30 matches that crowd in few places, and 25 of the
// floor.
TEST(FirstFeatures, RefuseNoPairWhoseOtherMotionHasMorePlaces) {
  RandomStream random(4);
  test::Points p, q;
  for (int i = 0; i < 155; ++i) {
    const bool is_vehicle = i < 30;
    const double reach_m = is_vehicle ? 0.06 : 1.0;
    q.emplace_back(random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m));
    p.push_back(is_vehicle ? q.back() : transform(test::kTrueMotion, q.back()));
  }
  const Registration with = register_pair(test::labelled(p), test::labelled(q), first(55), 1);
  EXPECT_TRUE(with.found) << with.reason;
  EXPECT_LT(with.evidence.rival_places, 15);
  EXPECT_LT((with.motion.position() - test::kTrueMotion.position()).norm(), 1e-3);
}

// Where few features would be left out there is nothing to gain.
TEST(FirstFeatures, AreNotTriedWhereTheyAreNearlyAll) {
  const FloorFeatures a = seen_at({-1.3, -1.2, 0.0});
  const FloorFeatures b = seen_at({1.0, 1.2, 0.4});
  const auto all = static_cast<int>(std::max(a.size(), b.size()));
  EXPECT_THAT(register_pair(a, b, first(all), 1).reason, Not(HasSubstr("strongest features")));
}

}  // namespace
}  // namespace fathom
