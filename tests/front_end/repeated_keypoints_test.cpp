#include "fathom/front_end/repeated_keypoints.hpp"

#include <memory>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "front_end/estimate.hpp"

namespace fathom {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;

struct Loop {
  std::size_t from = 0;
  std::size_t to = 0;
  std::optional<int> inliers = std::nullopt;
};

// Keyframes at these poses with these registrations, by rising `to`.
MeasurementLog log_of(const std::vector<Pose>& poses, const std::vector<Loop>& loops) {
  const Eigen::Matrix3d C = 1e-4 * Eigen::Matrix3d::Identity();
  MeasurementLog log(poses.front());
  for (std::size_t k = 1; k < poses.size(); ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, between(poses[k - 1], poses[k]), C));
    for (const Loop& loop : loops) {
      if (loop.to != k) continue;
      RelativePose z =
          RelativePose::from_covariance(loop.from, k, between(poses[loop.from], poses[k]), C);
      z.inliers = loop.inliers;
      log.add_registration(z);
    }
  }
  return log;
}

std::vector<double> repeats(const std::vector<Pose>& poses, const std::vector<Loop>& loops) {
  // Each sees 2 m along its x and 3 m across.
  const std::vector<Stance> stances(poses.size(), Stance(1.0));
  return repeats_of_keypoints(log_of(poses, loops), test::wide_camera(), stances);
}

// N (N − 1) / 2 registrations tell no more than N − 1.
TEST(RepeatedKeypoints, OfPicturesOfOnePlaceCountOnce) {
  std::vector<Pose> poses;
  std::vector<Loop> loops;
  for (std::size_t k = 0; k < 6; ++k) {
    poses.push_back({});
    for (std::size_t i = 0; i < k; ++i) loops.push_back({i, k});
  }
  EXPECT_THAT(repeats(poses, loops), Each(DoubleNear(3.0, 1e-12)));
}

TEST(RepeatedKeypoints, AreNoneOfASinglePair) {
  EXPECT_THAT(repeats({{0.0, 0.0, 0.3}, {0.5, 0.2, 2.9}}, {{0, 1}}), Each(DoubleNear(1.0, 1e-12)));
}

// The picture in the middle has one half in common with each, by whichever way they are turned.
TEST(RepeatedKeypoints, AreNoneWhereOtherPlacesAreMatched) {
  for (const double turn_rad : {0.0, 3.14159265358979}) {
    EXPECT_THAT(
        repeats({{-1.05, 0.0, turn_rad}, {0.0, 0.0, 0.0}, {1.05, 0.0, turn_rad}}, {{0, 1}, {1, 2}}),
        Each(DoubleNear(1.0, 1e-12)));
  }
}

// Pictures 0 and 2 share the place of 1 with it: half of the ends of each pair are in two.
TEST(RepeatedKeypoints, CountOverBothPictures) {
  EXPECT_THAT(repeats({{}, {}, {}}, {{0, 1}, {1, 2}}), Each(DoubleNear(1.25, 1e-12)));
}

// One that finds a tenth of the matches leaves most keypoints of the other to that one alone.
TEST(RepeatedKeypoints, CountByTheDensityOfMatches) {
  const std::vector<double> found = repeats({{}, {}, {}}, {{0, 1, 200}, {1, 2, 20}});
  EXPECT_NEAR(found[0], 0.5 * (1.0 + 0.5 * (1.0 + 1.1)), 1e-12);
  EXPECT_NEAR(found[1], 0.5 * (1.0 + 0.5 * (1.0 + 2.0)), 1e-12);
}

// Forty matches in a strip of 10 cm are denser than any number over a whole picture.
TEST(RepeatedKeypoints, AreNotCountedByASliver) {
  const std::vector<Loop> loops{{0, 1, 200}, {0, 2, 200}, {1, 2, 200}, {2, 3, 40}};
  const std::vector<double> found = repeats({{}, {}, {}, {1.9, 0.0, 0.0}}, loops);
  EXPECT_NEAR(found[0], 1.5, 1e-12);
  EXPECT_GT(found[1], 1.5 - 1e-12);
}

TEST(RepeatedKeypoints, MakeTheOwnCovarianceLargerAndNoOther) {
  SharedErrors shared;
  shared.from.sigma[0] = shared.to.sigma[1] = 0.02;
  shared.from.G = shared.to.G = Eigen::Matrix3d::Random();
  shared.own = 1e-4 * Eigen::Matrix3d::Identity();
  RelativePose z = RelativePose::from_covariance(0, 1, {1.0, 0.2, 0.5}, shared.total());
  z.shared = std::make_shared<const SharedErrors>(shared);
  MeasurementLog log;
  log.add_keyframe(RelativePose::from_covariance(0, 1, {1.0, 0.2, 0.5}, shared.own));
  log.add_registration(z);
  const std::vector<double> three{3.0};
  const MeasurementLog once = count_keypoints_once(log, three);
  const RelativePose& counted = once.arrival(1).registrations.front();
  EXPECT_EQ(counted.repeats, 3.0);
  EXPECT_EQ(counted.shared->from, shared.from);
  EXPECT_LT((counted.shared->own - 3.0 * shared.own).norm(), 1e-18);
  EXPECT_LT((counted.covariance() - counted.shared->total()).norm(), 1e-12);
  const RelativePose alone = counted.alone();
  EXPECT_EQ(alone.repeats, 1.0);
  EXPECT_LT((alone.covariance() - z.covariance()).norm(), 1e-12);
  EXPECT_EQ(once.arrival(1).step.information, log.arrival(1).step.information);
}

}  // namespace
}  // namespace fathom
