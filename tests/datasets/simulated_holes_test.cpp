// Holes in simulated dead reckoning.

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "datasets/small_log.hpp"
#include "fathom/datasets/simulated_sensors.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::flown;
using test::input_error_of;
using test::sweep;

TEST(SimulatedHoles, HolesHaveTheirNumberAndLength) {
  std::vector<std::int64_t> times_ns;
  for (std::int64_t i = 0; i <= 100; ++i) times_ns.push_back(i * 500'000'000);
  std::vector<std::size_t> first(101, 0);
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const auto is_hole = draw_holes({3, 4.0}, times_ns, 5, trial, "dataset.");
    EXPECT_FALSE(is_hole[0]);
    std::size_t holes = 0;
    std::size_t motions = 0;
    for (std::size_t i = 1; i < is_hole.size(); ++i) {
      motions += is_hole[i] ? 1 : 0;
      if (!is_hole[i] || is_hole[i - 1]) continue;
      ++holes;
      ++first[i];
    }
    EXPECT_EQ(holes, 3u);
    EXPECT_EQ(motions, 24u);
  }
  // Anywhere: at the very beginning, at the very end.
  EXPECT_GT(first[1], 0u);
  EXPECT_GT(first[93], 0u);
}

TEST(SimulatedHoles, AHoleIsDeclaredAsAWhole) {
  std::vector<std::int64_t> times_ns;
  for (std::int64_t i = 0; i <= 20; ++i) times_ns.push_back(i * 500'000'000);
  std::vector<bool> is_hole(21, false);
  for (std::size_t i = 5; i <= 10; ++i) is_hole[i] = true;
  GapOptions gaps;
  gaps.speed_limit_m_s = 2.0;
  gaps.sigma_rad = 0.5;
  const auto motions = hole_motions(is_hole, times_ns, gaps);
  EXPECT_FALSE(motions[4]);
  EXPECT_FALSE(motions[11]);
  UncertainPose whole;
  for (std::size_t i = 5; i <= 10; ++i) whole = compose(whole, motions[i].value());
  // 3 s at 2 m/s.
  EXPECT_NEAR(whole.covariance(0, 0), 36.0, 1e-12);
  EXPECT_NEAR(whole.covariance(2, 2), 0.25, 1e-12);
  EXPECT_EQ(whole.mean, Pose{});
  gaps.sigma_m = 4.0;
  EXPECT_NEAR(hole_motions(is_hole, times_ns, gaps)[5]->covariance(1, 1), 16.0 / 6.0, 1e-12);
}

TEST(SimulatedHoles, ALogHasHolesWhereItsFramesHave) {
  SimulatedLogOptions options = sweep();
  options.sensors.holes = {2, 4.0};
  const MeasurementLog log = draw_log(flown(options), options, 1, 0);
  EXPECT_GE(log.hole_count(), 4u);
  EXPECT_LE(log.hole_count(), 8u);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose& step = log.arrival(k).step;
    EXPECT_EQ(step.is_hole, step.covariance()(2, 2) > 0.1);
  }
}

TEST(SimulatedHoles, RefusesWhatDoesNotFit) {
  const std::vector<std::int64_t> times_ns{0, 1'000'000'000, 2'000'000'000};
  EXPECT_EQ(input_error_of([&] {
              draw_holes({2, 1.0}, times_ns, 1, 0, "dataset.");
            }),
            "dataset.holes.length_s: 2 of 1 s do not fit into a survey of 2 s; expected shorter or "
            "fewer ones");
}

}  // namespace
}  // namespace fathom
