// A second dive over the same floor: loops over the hole before it.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"

namespace fathom {
namespace {

using test::configured;

// Two rounds over the same floor. No two consecutive keyframes overlap, so dead reckoning alone
// holds a round together; between the rounds it has a hole.
constexpr const char* kTwoDives = R"(dataset:
  type: simulated
  world: {metres_per_pixel: 0.005}
  mission: {type: waypoints, turn_radius_m: 0.5, waypoints_m: [0, 0, 7, 0, 7, 1.5, -1, 1.5,
            -1, 0.1, 7, 0.1, 7, 1.6, 0, 1.6]}
  altitude: {base_m: 0.7}
  camera: {width: 160, height: 120, fx: 130, fy: 130}
  odometry: {sigma_x_m: 0.003, sigma_y_m: 0.003, sigma_theta_rad: 0.003}
  holes: {count: 1, length_s: 3}
front_end:
  keyframes: {separation_frames: 3}
  candidates: {max_distance_m: 0.5}
  ransac: {max_error_m: 0.02}
)";

constexpr int kSeed = 1;

Recording recorded(const std::string& more) {
  return record(configured(std::string(kTwoDives) + "seed: " + std::to_string(kSeed) + "\n" + more),
                builtin_estimators());
}

std::pair<std::size_t, std::size_t> hole_of(const MeasurementLog& log) {
  std::vector<std::size_t> holes;
  for (std::size_t k = 1; k < log.size(); ++k) {
    if (log.arrival(k).step.is_hole) holes.push_back(k);
  }
  return {holes.front(), holes.back()};
}

std::vector<RelativePose> over_hole(const MeasurementLog& log) {
  const auto [first, last] = hole_of(log);
  std::vector<RelativePose> over;
  for (std::size_t k = last; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      if (z.from < first) over.push_back(z);
    }
  }
  return over;
}

double error_m(const Recording& recording, const std::string& estimator) {
  MetricOptions metrics;
  metrics.alignment = Alignment::none;
  const Result result = evaluate(recording, {estimator, estimator, {}}, builtin_estimators(),
                                 {.metrics = metrics}, {});
  EXPECT_TRUE(result.is_done()) << estimator;
  return result.metric("mean_position_error_m").value_or(1e9);
}

TEST(HoleRecording, ASecondDiveOverTheSameFloorIsFoundWithinAFewKeyframes) {
  for (const std::string method : {"distance", "overlap"}) {
    const std::string by = method == "overlap" ? "front_end.candidates.max_distance_m: off\n" : "";
    const std::string candidates = "front_end.candidates.method: " + method + "\n" + by;
    const Recording guessed = recorded(candidates + "front_end.candidates.hole_budget: 0\n");
    EXPECT_EQ(over_hole(guessed.log).size(), 0u) << method;
    EXPECT_GT(error_m(guessed, "trajectory_iekf"), 0.5);
    const Recording found = recorded(candidates);
    const auto over = over_hole(found.log);
    ASSERT_GT(over.size(), 5u) << method;
    EXPECT_LE(over.front().to, hole_of(found.log).second + 6) << method;
    for (const char* estimator : {"trajectory_iekf", "sparse_gauss_newton"}) {
      EXPECT_LT(error_m(found, estimator), 0.05) << estimator;
    }
  }
}

}  // namespace
}  // namespace fathom
