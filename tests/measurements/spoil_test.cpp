// False loops: how many, how false, which keyframes, and the same again.

#include "fathom/measurements/spoil.hpp"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimators/logs.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

const std::vector<FalseLoopKind> kKinds{FalseLoopKind::random, FalseLoopKind::local,
                                        FalseLoopKind::grouped};

struct LogAndTruth {
  MeasurementLog log;
  std::vector<Pose> truth;
};

LogAndTruth circle_case(std::size_t keyframes = 120) {
  test::LogOptions options;
  options.keyframes = keyframes;
  options.loop_every = 2;
  return {test::circle_log(options), test::circle(keyframes)};
}

std::vector<RelativePose> false_ones(const Spoiled& spoiled) {
  std::vector<RelativePose> loops;
  std::size_t place = 0;
  for (std::size_t k = 1; k < spoiled.log.size(); ++k) {
    for (const RelativePose& z : spoiled.log.arrival(k).registrations) {
      if (spoiled.is_false[place++]) loops.push_back(z);
    }
  }
  return loops;
}

TEST(Spoil, AddsTheShareAndLeavesTheRestAlone) {
  const auto [log, truth] = circle_case();
  const std::size_t right = log.registration_count();
  for (const FalseLoopKind kind : kKinds) {
    for (const double share : {0.1, 0.3, 0.5}) {
      const Spoiled spoiled = spoil(log, truth, {.share = share, .kind = kind}, 4);
      const std::size_t added = spoiled.log.registration_count() - right;
      EXPECT_NEAR(static_cast<double>(added), share / (1.0 - share) * static_cast<double>(right),
                  0.5);
      EXPECT_EQ(false_ones(spoiled).size(), added);
      ASSERT_EQ(spoiled.log.size(), log.size());
      std::size_t place = 0;
      for (std::size_t k = 1; k < log.size(); ++k) {
        std::size_t next = 0;
        for (const RelativePose& z : spoiled.log.arrival(k).registrations) {
          if (spoiled.is_false[place++]) continue;
          EXPECT_EQ(z.motion, log.arrival(k).registrations[next].motion);
          EXPECT_EQ(z.from, log.arrival(k).registrations[next++].from);
        }
        EXPECT_EQ(next, log.arrival(k).registrations.size());
        EXPECT_EQ(spoiled.log.arrival(k).step.motion, log.arrival(k).step.motion);
      }
    }
  }
}

TEST(Spoil, EveryFalseLoopIsOffByAMetreOrAFifthOfARadian) {
  const auto [log, truth] = circle_case();
  for (const FalseLoopKind kind : kKinds) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      for (const RelativePose& z :
           false_ones(spoil(log, truth, {.share = 0.5, .kind = kind}, seed))) {
        const Pose right = between(truth[z.from], truth[z.to]);
        const double off_m = (z.motion.position() - right.position()).norm();
        const double off_rad = std::abs(wrap_angle(z.motion.theta - right.theta));
        EXPECT_TRUE(off_m >= 1.0 || off_rad >= 0.2) << off_m << " " << off_rad;
        EXPECT_LT(z.from, z.to);
      }
    }
  }
}

TEST(Spoil, LocalOnesStayWithinReach) {
  const auto [log, truth] = circle_case();
  const SpoilOptions options{.share = 0.5, .kind = FalseLoopKind::local, .reach = 7};
  std::set<std::size_t> spans;
  for (const RelativePose& z : false_ones(spoil(log, truth, options, 1))) {
    spans.insert(z.to - z.from);
  }
  EXPECT_EQ(*spans.rbegin(), 7u);
  EXPECT_GE(*spans.begin(), 2u);
}

// Carried along the true motions each loop of a group says what its first says, up to noise.
TEST(Spoil, GroupsAgree) {
  const auto [log, truth] = circle_case();
  const SpoilOptions options{.share = 0.5, .kind = FalseLoopKind::grouped, .group_size = 4};
  const Spoiled spoiled = spoil(log, truth, options, 2);
  const std::vector<RelativePose> loops = false_ones(spoiled);
  std::size_t with_a_next = 0;
  for (const RelativePose& a : loops) {
    for (const RelativePose& b : loops) {
      if (b.from != a.from + 1 || b.to != a.to + 1) continue;
      const Pose expected = compose(compose(between(truth[b.from], truth[a.from]), a.motion),
                                    between(truth[a.to], truth[b.to]));
      if ((expected.position() - b.motion.position()).norm() < 0.1) ++with_a_next;
    }
  }
  // Three of four have one, but for the last group.
  EXPECT_GE(with_a_next, loops.size() * 3 / 4 - 3);
}

TEST(Spoil, IsReproducible) {
  const LogAndTruth circle = circle_case();
  const SpoilOptions options{.share = 0.3};
  const auto motions = [&](std::uint64_t seed, std::uint64_t trial) {
    std::vector<Eigen::Vector3d> all;
    for (const RelativePose& z :
         false_ones(spoil(circle.log, circle.truth, options, seed, trial))) {
      all.push_back(z.motion.vector());
      all.emplace_back(static_cast<double>(z.from), static_cast<double>(z.to), 0.0);
    }
    return all;
  };
  EXPECT_EQ(motions(1, 0), motions(1, 0));
  EXPECT_NE(motions(1, 0), motions(2, 0));
  EXPECT_NE(motions(1, 0), motions(1, 1));
}

// Written and read again, steps and loops are the same: also over holes and reversed steps.
TEST(Spoil, NoFalseLoopIsReadAsAStep) {
  const auto [log, truth] = circle_case(12);
  MeasurementLog mixed;
  for (std::size_t k = 1; k < log.size(); ++k) {
    RelativePose step = k % 3 == 0 ? log.arrival(k).step.reversed() : log.arrival(k).step;
    step.is_hole = k % 3 == 1;
    mixed.add_keyframe(step);
    for (const RelativePose& z : log.arrival(k).registrations) mixed.add_registration(z);
  }
  std::size_t along_steps = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Spoiled spoiled = spoil(mixed, truth, {.share = 0.8}, seed);
    for (const RelativePose& z : false_ones(spoiled)) {
      along_steps += z.from + 1 == z.to || z.to + 1 == z.from ? 1 : 0;
    }
    const MeasurementLog read = parse_g2o(to_g2o(spoiled.log), "spoilt.g2o");
    EXPECT_EQ(read.hole_count(), mixed.hole_count());
    ASSERT_EQ(read.registration_count(), spoiled.log.registration_count());
    for (std::size_t k = 1; k < mixed.size(); ++k) {
      EXPECT_EQ(read.arrival(k).step.motion, mixed.arrival(k).step.motion) << k;
      const auto& loops = spoiled.log.arrival(k).registrations;
      for (std::size_t i = 0; i < loops.size(); ++i) {
        EXPECT_EQ(read.arrival(k).registrations[i].motion, loops[i].motion) << k;
      }
    }
  }
  EXPECT_GT(along_steps, 20u);
}

TEST(Spoil, AReachBeyondTheLogIsTheWholeLog) {
  const LogAndTruth circle = circle_case(40);
  SpoilOptions options{.share = 0.5, .kind = FalseLoopKind::local, .reach = 1'000'000};
  const auto spans = [&] {
    std::vector<std::size_t> all;
    for (const RelativePose& z : false_ones(spoil(circle.log, circle.truth, options, 1))) {
      all.push_back(z.to - z.from);
    }
    return all;
  };
  const std::vector<std::size_t> far = spans();
  EXPECT_FALSE(far.empty());
  options.reach = 39;
  EXPECT_EQ(far, spans());
}

TEST(Spoil, SaysThatTheLogIsTooShort) {
  const LogAndTruth circle = circle_case(30);
  const auto refusal = [&](const SpoilOptions& options) {
    return test::input_error_of([&] { spoil(circle.log, circle.truth, options, 1); });
  };
  SpoilOptions options{.share = 0.9, .kind = FalseLoopKind::grouped, .group_size = 16};
  EXPECT_THAT(refusal(options), testing::HasSubstr("groups of 16 false loops do not fit into a log "
                                                   "of 30 keyframes, or hardly anywhere; expected "
                                                   "a group size of at most 7"));
  options.group_size = 14;
  EXPECT_NO_THROW(spoil(circle.log, circle.truth, options, 1));
  MeasurementLog two;
  two.add_keyframe(circle.log.arrival(1).step);
  two.add_registration(circle.log.arrival(1).step);
  options = {.share = 0.5, .kind = FalseLoopKind::local};
  EXPECT_THAT(test::input_error_of([&] { spoil(two, two.odometry(), options, 1); }),
              testing::HasSubstr("two apart or more, and the log has 2"));
}

TEST(Spoil, RefusesWhereNothingCanBeFalse) {
  test::LogOptions none;
  none.loop_every = 0;
  const MeasurementLog without = test::circle_log(none);
  EXPECT_EQ(spoil(without, without.odometry(), {.share = 0.5}, 1).log.registration_count(), 0u);
  // All keyframes in one place: what one loop says holds for all of them.
  MeasurementLog still;
  const Eigen::Matrix3d C = 1e-6 * Eigen::Matrix3d::Identity();
  for (std::size_t k = 1; k < 6; ++k) {
    still.add_keyframe(RelativePose::from_covariance(k - 1, k, {}, C));
  }
  still.add_registration(RelativePose::from_covariance(0, 5, {}, C));
  EXPECT_THROW(spoil(still, still.odometry(), {.share = 0.5}, 1), InputError);
}

}  // namespace
}  // namespace fathom
