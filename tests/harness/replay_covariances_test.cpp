// Which covariances the harness asks for along with an estimate, and whom their time is charged to.

#include <algorithm>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/replay.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/scripted_replay.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using test::FakeMeter;
using test::replayed;
using test::Script;
using test::square_log;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> first_calls(const Script& script, std::ptrdiff_t count) {
  return {script.calls.begin(), script.calls.begin() + count};
}

// The same duty whatever the keyframe brought, and after its update. Its memory is not counted.
TEST(ReplayCovariances, TheNewestIsAskedForOnceAKeyframe) {
  Script script;
  script.joint_covariances = 100;
  FakeMeter meter(script);
  ReplayOptions options;
  options.newest_covariances = true;
  options.memory = &meter;
  const auto result = replayed(script, options);
  EXPECT_THAT(first_calls(script, 13),
              ElementsAre("start", "create", "add 1", "pause", "covariance 1", "resume", "add 2",
                          "pause", "covariance 2", "resume", "add 3", "pause", "covariance 3"));
  const auto update = std::ranges::find(script.calls, "close 0-4");
  ASSERT_NE(update, script.calls.end());
  EXPECT_EQ(*(update - 1), "add 4");
  EXPECT_EQ(*(update + 2), "covariance 4");
  EXPECT_EQ(result.costs.newest_covariance_ms.size(), 7u);
  EXPECT_FALSE(result.costs.candidate_covariance_ms);
}

TEST(ReplayCovariances, OfTheNewestAreOfAllKeyframesOrAbsent) {
  ReplayOptions options;
  Script silent;
  EXPECT_THAT(replayed(silent, options).costs.newest_covariance_ms, IsEmpty());
  EXPECT_EQ(std::ranges::count(silent.calls, "covariance 1"), 0);
  options.newest_covariances = true;
  Script script;
  script.joint_covariances = 3;
  EXPECT_THAT(replayed(script, options).costs.newest_covariance_ms, IsEmpty());
  EXPECT_EQ(std::ranges::count(script.calls, "covariance 4"), 1);
  EXPECT_EQ(std::ranges::count(script.calls, "covariance 5"), 0);
  options.mode = SolveMode::batch;
  Script batch;
  EXPECT_THAT(replayed(batch, options).costs.newest_covariance_ms, IsEmpty());
  EXPECT_EQ(std::ranges::count(batch.calls, "covariance 1"), 0);
}

// As the front end asks: before the registrations that they select are used.
TEST(ReplayCovariances, OfCandidatesAreChargedToTheEstimate) {
  Script script;
  script.joint_covariances = 100;
  ReplayOptions options;
  options.candidate_covariances = consecutive(1, square_log().size());
  const auto result = replayed(script, options);
  EXPECT_THAT(first_calls(script, 6), ElementsAre("create", "add 1", "covariance 0 1", "add 2",
                                                  "covariance 0 2", "covariance 1 2"));
  const auto update = std::ranges::find(script.calls, "close 0-4");
  ASSERT_NE(update, script.calls.end());
  EXPECT_EQ(*(update - 1), "covariance 3 4");
  ASSERT_TRUE(result.costs.candidate_covariance_ms);
  const auto sum = [](const std::vector<double>& times_ms) {
    return std::accumulate(times_ms.begin(), times_ms.end(), 0.0);
  };
  EXPECT_NEAR(result.costs.total_ms,
              sum(result.costs.update_ms) + sum(result.costs.add_ms) +
                  *result.costs.candidate_covariance_ms,
              1e-9);
  EXPECT_THAT(result.costs.newest_covariance_ms, IsEmpty());
}

TEST(ReplayCovariances, OfMotionsAreAskedForOnceAGroup) {
  Script script;
  script.joint_covariances = 1;
  ReplayOptions options;
  options.motions = {{MotionsOver::keyframes, 2.0, {{1, 3}, {3, 5}, {5, 1}}},
                     {MotionsOver::anchors, 1.0, {{2, 4}}}};
  const auto result = replayed(script, options);
  EXPECT_EQ(std::ranges::count(script.calls, "covariance 1 3 5"), 1);
  ASSERT_EQ(result.motions.size(), 2u);
  ASSERT_EQ(result.motions[0].covariances.size(), 3u);
  EXPECT_THAT(result.motions[1].covariances, IsEmpty());
  // Of two independent poses, each with the identity: J Jᵀ + 1 with the lever of the motion.
  const Pose h = between(result.trajectory[5], result.trajectory[1]);
  const Eigen::Vector2d lever(h.y, -h.x);
  Eigen::Matrix3d expected = 2.0 * Eigen::Matrix3d::Identity();
  expected.topLeftCorner<2, 2>() += lever * lever.transpose();
  expected.topRightCorner<2, 1>() = -lever;
  expected.bottomLeftCorner<1, 2>() = -lever.transpose();
  EXPECT_LT((result.motions[0].covariances[2] - expected).norm(), 1e-12);
}

TEST(ReplayCovariances, LeaveTheEstimateAsItIs) {
  const MeasurementLog log = square_log();
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    ReplayOptions options;
    options.newest_covariances = true;
    options.candidate_covariances = consecutive(1, square_log().size());
    const auto asked = replay(log, entry, {}, options);
    const auto plain = replay(log, entry, {}, {});
    EXPECT_EQ(asked.trajectory, plain.trajectory) << entry.name;
    EXPECT_EQ(*asked.covariances, *plain.covariances) << entry.name;
    EXPECT_EQ(asked.costs.newest_covariance_ms.size(), 7u) << entry.name;
  }
}

}  // namespace
}  // namespace fathom
