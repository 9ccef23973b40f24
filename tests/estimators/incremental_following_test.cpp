// Parts of the map that follow a loop as one are moved when somebody asks where they are: whoever
// asks, and whenever, is told the same.

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "estimators/incremental_smoother/smoother.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/smoother_logs.hpp"

namespace fathom {
namespace {

using test::arrive;
using test::make;

void expect_close(const Estimator& a, const Estimator& b, double tolerance) {
  ASSERT_LT(test::largest_distance(poses_of(a), poses_of(b)), tolerance);
  ASSERT_LT(test::largest_turn(poses_of(a), poses_of(b)), tolerance);
}

std::vector<MeasurementLog> long_logs() {
  return {test::tracks_log(900, 30), test::wandering_log(300, 2), test::wandering_log(300, 8)};
}

TEST(IncrementalFollowing, WhoNeverAskedKnowsTheSamePoses) {
  for (const MeasurementLog& log : long_logs()) {
    const auto asked = make("incremental_smoother", log.origin());
    const auto unasked = make("incremental_smoother", log.origin());
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*asked, log, k);
      arrive(*unasked, log, k);
      poses_of(*asked);
      if (k % 149 == 0) expect_close(*asked, *unasked, 1e-7);
    }
    expect_close(*asked, *unasked, 1e-7);
  }
}

TEST(IncrementalFollowing, OneKeyframeIsWhereTheWholeTrajectoryHasIt) {
  const MeasurementLog log = test::tracks_log(600, 30);
  const auto some = make("incremental_smoother", log.origin());
  const auto all = make("incremental_smoother", log.origin());
  RandomStream random(1, "asked");
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*some, log, k);
    arrive(*all, log, k);
    const std::size_t one = random.index(k + 1);
    const Pose expected = poses_of(*all)[one];
    ASSERT_LT(between(some->pose(one), expected).position().norm(), 1e-7) << k;
  }
}

// An update that fails leaves motions that earlier ones had not passed on.
TEST(IncrementalFollowing, AFailedUpdateLeavesNothing) {
  const MeasurementLog log = test::tracks_log(600, 30);
  const auto disturbed = make("incremental_smoother", log.origin());
  const auto undisturbed = make("incremental_smoother", log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*disturbed, log, k);
    arrive(*undisturbed, log, k);
    if (k % 97 != 0) continue;
    const std::vector<RelativePose> far{{2, k, {1e200, 0.0, 0.0}, Eigen::Matrix3d::Identity(), {}}};
    EXPECT_EQ(disturbed->update({far}).outcome, Outcome::numerical_failure);
    expect_close(*disturbed, *undisturbed, 1e-9);
    // Its tree is another from here on: it was built anew.
    const auto again = make("incremental_smoother", log.origin());
    for (std::size_t j = 1; j <= k; ++j) arrive(*again, log, j);
    expect_close(*disturbed, *again, 1e-2);
    return;
  }
}

TEST(IncrementalFollowing, SaysWhatHasMoved) {
  const MeasurementLog log = test::wandering_log(120, 4);
  const auto estimator = make("incremental_smoother", log.origin());
  std::uint64_t revision = 0;
  std::vector<Pose> known;
  std::size_t exact = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*estimator, log, k);
    if (k % 3 == 0) continue;  // two keyframes at once
    const MovedPoses moved = estimator->moved_since(revision);
    revision = moved.revision;
    if (moved.keyframes) ++exact;
    known.resize(estimator->size());
    for (const std::size_t j : moved.keyframes.value_or(consecutive(0, known.size()))) {
      known[j] = estimator->pose(j);
    }
    ASSERT_EQ(known, poses_of(*estimator)) << k;
  }
  EXPECT_GT(exact, 20U);
}

// Of a tree whose cliques are linearised within the default limits.
TEST(IncrementalFollowing, TheNewestCovarianceIsThatOfTheWholeGraph) {
  for (const MeasurementLog& log : long_logs()) {
    const auto estimator = make("incremental_smoother", log.origin());
    double worst = 0.0;
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*estimator, log, k);
      if (k % 10 != 0) continue;
      const std::size_t newest = k;
      const Eigen::Matrix3d exact = *estimator->joint_covariance(std::span(&newest, 1));
      const Eigen::Matrix3d L_inverse = Eigen::Matrix3d(exact.llt().matrixL()).inverse();
      const Eigen::Matrix3d ratio =
          L_inverse * *estimator->newest_covariance() * L_inverse.transpose();
      worst = std::max(worst, (ratio - Eigen::Matrix3d::Identity()).norm());
    }
    EXPECT_LT(worst, 0.02);
  }
}

}  // namespace
}  // namespace fathom
