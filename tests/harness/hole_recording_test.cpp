// A second dive over the same floor: loops over the hole before it.

#include <string>
#include <utility>
#include <vector>

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
  ransac: {max_error_m: 0.02}
)";

Recording recorded(const std::string& candidates, int hole_budget) {
  return record(configured(std::string(kTwoDives) + "  candidates: {" + candidates +
                           ", hole_budget: " + std::to_string(hole_budget) + "}\n"),
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

// The keyframes in the hole itself, which no other overlaps, are what is left of the error.
TEST(HoleRecording, ASecondDiveOverTheSameFloorIsFoundWithinAFewKeyframes) {
  for (const std::string candidates : {"max_distance_m: 0.5", "method: overlap"}) {
    const Recording guessed = recorded(candidates, 0);
    EXPECT_TRUE(over_hole(guessed.log).empty()) << candidates;
    EXPECT_TRUE(guessed.asked_covariances.empty());
    EXPECT_GT(error_m(guessed, "trajectory_iekf"), 0.3);
    const Recording found = recorded(candidates, 12);
    const auto over = over_hole(found.log);
    ASSERT_GT(over.size(), 5u) << candidates;
    const auto [begin, end] = hole_of(found.log);
    EXPECT_LE(over.front().to, end + 4) << candidates;
    EXPECT_EQ(found.asked_covariances.front(), begin);
    EXPECT_GT(found.registrations_left_out, 20u);
    for (const char* estimator : {"trajectory_iekf", "sparse_gauss_newton"}) {
      EXPECT_LT(error_m(found, estimator), 0.1) << estimator;
    }
  }
}

// Without a budget over holes mahalanobis tries all that may be, at once.
TEST(HoleRecording, MethodsThatGoByTheUncertaintyKeepWithinTheBudget) {
  const std::string mahalanobis = "max_distance_m: 0.5, method: mahalanobis";
  for (const std::string& candidates :
       {mahalanobis, std::string("method: possible_overlap, budget: 6")}) {
    const Recording found = recorded(candidates, 4);
    const auto over = over_hole(found.log);
    ASSERT_GT(over.size(), 5u) << candidates;
    EXPECT_LE(over.front().to, hole_of(found.log).second + 11) << candidates;
    if (candidates != mahalanobis) continue;
    EXPECT_LT(found.registrations_tried, recorded(candidates, 0).registrations_tried);
  }
}

}  // namespace
}  // namespace fathom
