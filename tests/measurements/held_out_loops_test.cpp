// Which loops are held out: drawn a pair at a time, never a step, a false loop or the only link.

#include "fathom/measurements/held_out_loops.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/disjoint_sets.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

RelativePose between_keyframes(std::size_t from, std::size_t to, bool is_hole = false) {
  RelativePose z =
      RelativePose::from_covariance(from, to, {1.0, 0.0, 0.1}, 0.01 * Eigen::Matrix3d::Identity());
  z.is_hole = is_hole;
  return z;
}

// Loops of every keyframe with the last four, the nearest one of which is consecutive.
MeasurementLog chain(std::size_t keyframes, std::size_t hole_before = 0) {
  MeasurementLog log;
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(between_keyframes(k - 1, k, k == hole_before));
    for (std::size_t back = 1; back <= std::min<std::size_t>(4, k); ++back) {
      log.add_registration(between_keyframes(k - back, k));
    }
  }
  return log;
}

Pairs pairs_of(const std::vector<RelativePose>& loops) {
  Pairs pairs;
  for (const RelativePose& z : loops) pairs.emplace_back(std::minmax(z.from, z.to));
  std::ranges::sort(pairs);
  return pairs;
}

Pairs drawn_from(const MeasurementLog& log, double share, std::uint64_t seed = 1,
                 std::uint64_t trial = 0) {
  return pairs_of(held_out_of(log, draw_held_out(log, {}, share, seed, trial)));
}

TEST(HeldOutLoops, AreAShareOfThoseThatAreNoSteps) {
  const MeasurementLog log = chain(2000);
  const Pairs drawn = drawn_from(log, 0.1);
  for (const auto& [from, to] : drawn) EXPECT_GT(to - from, 1u);
  // Of 5991; the standard deviation of the binomial is 23.
  EXPECT_NEAR(static_cast<double>(drawn.size()), 599.0, 70.0);
  EXPECT_EQ(drawn, drawn_from(log, 0.1));
  EXPECT_NE(drawn, drawn_from(log, 0.1, 1, 1));
  EXPECT_NE(drawn, drawn_from(log, 0.1, 2));
  EXPECT_TRUE(drawn_from(log, 0.0).empty());
  EXPECT_TRUE(std::ranges::includes(drawn_from(log, 0.2), drawn));
}

// Another estimator's own log: fewer loops, some written from the other end.
TEST(HeldOutLoops, APairIsInOrOutWhateverElseALogHas) {
  const MeasurementLog log = chain(300);
  MeasurementLog other;
  std::map<std::pair<std::size_t, std::size_t>, bool> in_other;
  for (std::size_t k = 1; k < log.size(); ++k) {
    other.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      if (z.from % 3 == 0) continue;
      other.add_registration(z.from % 3 == 1 ? z : z.reversed());
      in_other[{z.from, z.to}] = true;
    }
  }
  Pairs expected;
  for (const auto& pair : drawn_from(log, 0.3)) {
    if (in_other.contains(pair)) expected.push_back(pair);
  }
  EXPECT_GT(expected.size(), 50u);
  EXPECT_EQ(drawn_from(other, 0.3), expected);
}

TEST(HeldOutLoops, WhatIsMeasuredTwiceIsHeldOutTwice) {
  MeasurementLog log = chain(50);
  const RelativePose again = log.arrival(49).registrations.back();
  log.add_registration(again);
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    const auto is_held_out = draw_held_out(log, {}, 0.3, 1, trial);
    EXPECT_EQ(is_held_out[is_held_out.size() - 1], is_held_out[is_held_out.size() - 2]);
  }
}

TEST(HeldOutLoops, FalseOnesAreNot) {
  const MeasurementLog log = chain(300);
  const std::vector<bool> drawn = draw_held_out(log, {}, 0.5, 1, 0);
  std::vector<bool> is_false(drawn.size());
  for (std::size_t place = 0; place < is_false.size(); place += 3) is_false[place] = true;
  const std::vector<bool> right = draw_held_out(log, is_false, 0.5, 1, 0);
  for (std::size_t place = 0; place < drawn.size(); ++place) {
    EXPECT_EQ(right[place], drawn[place] && !is_false[place]) << place;
  }
}

std::size_t connected_parts(const MeasurementLog& log) {
  DisjointSets sets(log.size());
  for (const RelativePose& z : log.edges()) sets.join(z.from, z.to);
  std::size_t parts = 0;
  for (std::size_t k = 0; k < log.size(); ++k) parts += sets.root(k) == k ? 1 : 0;
  return parts;
}

// Behind the hole hang two loops.
TEST(HeldOutLoops, WhatLiesBehindAHoleKeepsALink) {
  MeasurementLog log;
  for (std::size_t k = 1; k < 8; ++k) log.add_keyframe(between_keyframes(k - 1, k, k == 5));
  log.add_registration(between_keyframes(1, 7));
  log.add_registration(between_keyframes(7, 2));
  std::size_t both = 0;
  std::size_t one = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    const auto is_held_out = draw_held_out(log, {}, 0.5, 1, trial);
    EXPECT_EQ(connected_parts(log_without(log, is_held_out)), 1u);
    one += is_held_out[0] != is_held_out[1] ? 1 : 0;
    both += !is_held_out[0] && !is_held_out[1] ? 1 : 0;
  }
  // One stays where one or two were drawn.
  EXPECT_NEAR(static_cast<double>(one), 150.0, 25.0);
  EXPECT_EQ(one + both, 200u);
  // A false loop is no link.
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    EXPECT_THAT(draw_held_out(log, {false, true}, 0.5, 1, trial), ElementsAre(false, false));
  }
}

TEST(HeldOutLoops, TheRestOfTheLogStays) {
  MeasurementLog log = chain(30);
  AbsolutePose fix;
  fix.keyframe = 29;
  log.add_absolute(fix);
  for (std::size_t k = 0; k < log.size(); ++k) log.ids.push_back(static_cast<std::int64_t>(7 * k));
  log.guess = log.odometry();
  log.self_edges = 3;
  const std::vector<bool> is_held_out = draw_held_out(log, {}, 0.3, 1, 0);
  const MeasurementLog rest = log_without(log, is_held_out);
  EXPECT_EQ(rest.size(), log.size());
  EXPECT_EQ(rest.odometry(), log.odometry());
  EXPECT_EQ(rest.ids, log.ids);
  EXPECT_EQ(rest.guess, log.guess);
  EXPECT_EQ(rest.self_edges, 3u);
  EXPECT_EQ(rest.absolute_count(), 1u);
  Pairs expected = pairs_of(held_out_of(log, std::vector<bool>(is_held_out.size(), true)));
  const Pairs held_out = pairs_of(held_out_of(log, is_held_out));
  EXPECT_FALSE(held_out.empty());
  std::erase_if(expected, [&](const auto& pair) { return std::ranges::count(held_out, pair) > 0; });
  const std::vector<bool> all(rest.registration_count(), true);
  EXPECT_EQ(pairs_of(held_out_of(rest, all)), expected);
}

}  // namespace
}  // namespace fathom
