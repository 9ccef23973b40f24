#include "src/datasets/simulated_log/simulated_log.hpp"

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/small_log.hpp"
#include "fathom/datasets/data_set.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::error_of;
using test::flown;
using test::input_error_of;
using test::registrations_of;
using test::sweep;
using ::testing::HasSubstr;

TEST(SimulatedLog, WithHardlyAnyNoiseItIsTheTruth) {
  SimulatedLogOptions options = sweep();
  for (DrawnNoiseOptions* noise : {&options.odometry, &options.loops.noise}) {
    noise->sigma_x_m = noise->sigma_y_m = noise->sigma_theta_rad = 1e-9;
  }
  const FlownKeyframes keyframes = flown(options);
  const MeasurementLog log = draw_log(keyframes, options, 1, 0);
  ASSERT_EQ(log.size(), keyframes.size());
  EXPECT_EQ(log.size(), (keyframes.frames.size() - 1) / 3 + 1);
  for (std::size_t k = 1; k < log.size(); ++k) {
    EXPECT_LT(error_of(log.arrival(k).step, keyframes).norm(), 1e-7);
    EXPECT_EQ(log.arrival(k).step.from, k - 1);
    for (const RelativePose& z : log.arrival(k).registrations) {
      EXPECT_LT(error_of(z, keyframes).norm(), 1e-7);
      EXPECT_LT(z.from, k);
      EXPECT_EQ(z.to, k);
    }
  }
}

TEST(SimulatedLog, SuccessFallsInALineWithDistance) {
  SimulatedLogOptions options = sweep();
  options.loops.probability = 0.8;
  options.loops.max_distance_m = 2.0;
  const FlownKeyframes keyframes = flown(options);
  constexpr std::uint64_t kTrials = 400;
  std::map<std::pair<std::size_t, std::size_t>, int> found;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    for (const RelativePose& z : registrations_of(draw_log(keyframes, options, 7, trial))) {
      ++found[{z.from, z.to}];
    }
  }
  std::size_t pairs = 0;
  for (std::size_t to = 1; to < keyframes.size(); ++to) {
    for (std::size_t from = 0; from < to; ++from) {
      const double distance_m = std::hypot(keyframes[to].pose.x - keyframes[from].pose.x,
                                           keyframes[to].pose.y - keyframes[from].pose.y);
      const double chance = std::max(0.0, 0.8 * (1.0 - distance_m / 2.0));
      const auto place = found.find({from, to});
      const int count = place == found.end() ? 0 : place->second;
      EXPECT_NEAR(count, kTrials * chance, 4.5 * std::sqrt(kTrials * chance * (1.0 - chance)))
          << from << ' ' << to;
      if (chance > 0.0) ++pairs;
    }
  }
  EXPECT_GT(pairs, 30U);
}

TEST(SimulatedLog, TheNearestAreKeptInOrder) {
  SimulatedLogOptions options = sweep();
  options.loops.probability = 1.0;
  options.loops.max_distance_m = 3.0;
  const FlownKeyframes keyframes = flown(options);
  const MeasurementLog all = draw_log(keyframes, options, 2, 0);
  options.loops.max_per_keyframe = 2;
  const MeasurementLog some = draw_log(keyframes, options, 2, 0);
  std::size_t left_out = 0;
  for (std::size_t k = 1; k < all.size(); ++k) {
    const auto distance_m = [&](const RelativePose& z) {
      return (keyframes[z.from].pose.position() - keyframes[k].pose.position()).norm();
    };
    const auto& kept = some.arrival(k).registrations;
    ASSERT_EQ(kept.size(), std::min<std::size_t>(2, all.arrival(k).registrations.size()));
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LT(kept[i - 1].from, kept[i].from);
    std::set<std::size_t> ids;
    double farthest_m = 0.0;
    for (const RelativePose& z : kept) {
      ids.insert(z.from);
      farthest_m = std::max(farthest_m, distance_m(z));
    }
    for (const RelativePose& z : all.arrival(k).registrations) {
      if (ids.contains(z.from)) continue;
      EXPECT_GE(distance_m(z), farthest_m);
      ++left_out;
    }
  }
  EXPECT_GT(left_out, 10U);
}

// What changes an error changes no other draw.
TEST(SimulatedLog, EveryDrawIsItsOwn) {
  SimulatedLogOptions options = sweep();
  const FlownKeyframes keyframes = flown(options);
  const MeasurementLog few = draw_log(keyframes, options, 4, 9);
  options.loops.probability = 1.0;
  options.loops.tail_share = 0.01;
  options.loops.noise.sigma_x_m = 0.005;
  const MeasurementLog more = draw_log(keyframes, options, 4, 9);
  EXPECT_GT(more.registration_count(), few.registration_count());
  std::size_t same = 0;
  for (std::size_t k = 1; k < few.size(); ++k) {
    EXPECT_EQ(few.arrival(k).step.motion, more.arrival(k).step.motion);
    for (const RelativePose& z : few.arrival(k).registrations) {
      const auto& others = more.arrival(k).registrations;
      const auto other = std::ranges::find(others, z.from, &RelativePose::from);
      ASSERT_NE(other, others.end());
      if (other->motion == z.motion) ++same;
    }
  }
  // All but those that fell into the tail.
  EXPECT_GE(same, few.registration_count() * 9 / 10);
  const MeasurementLog next = draw_log(keyframes, options, 4, 10);
  EXPECT_NE(next.arrival(1).step.motion, more.arrival(1).step.motion);
}

TEST(SimulatedLog, BadValuesNameTheirKey) {
  const auto message = [](const std::vector<std::pair<std::string, std::string>>& given) {
    DataSetValues values;
    for (const auto& [key, value] : given) values[key] = OptionValue::scalar(value);
    return input_error_of([&] {
      find_data_set("simulated_log").open(values, 1)->trial(values, {1, 0});
    });
  };
  EXPECT_THAT(message({{"separation_frames", "100000"}}),
              HasSubstr("dataset.separation_frames: leads beyond the last frame"));
  EXPECT_THAT(message({{"odometry.sigma_y_m", "0"}}), HasSubstr("dataset.odometry.sigma_y_m: "));
  EXPECT_THAT(message({{"loops.sigma_theta_rad", "0"}}),
              HasSubstr("dataset.loops.sigma_theta_rad: "));
  EXPECT_THAT(message({{"odometry.sigma_x_m", "1e300"}}),
              HasSubstr("dataset.odometry.sigma_x_m: "));
  EXPECT_THAT(message({{"mission.turn_radius_m", "100"}}), HasSubstr("dataset.mission."));
}

}  // namespace
}  // namespace fathom
