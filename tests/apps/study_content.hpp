#pragma once

#include <cstddef>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {

/// Two cells over the same pictures, five trials; each takes well under a second.
inline constexpr const char* kStudy = R"(
dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: sweep, legs: 2, leg_length_m: 3, leg_spacing_m: 1}
  altitude: {altimeter_sigma_m: 0}
  camera: {width: 200, height: 150, fx: 150, fy: 150}
front_end:
  keyframes: {separation_frames: 3}
  ransac: {max_error_m: 0.05}
association: {mode: own}
sweep:
  - {key: dataset.odometry.sigma_theta_rad, name: heading noise, values: [0.01, 0.03]}
trials: 5
)";

/// Deterministic series: all but what a clock says.
inline const std::vector<std::string> kSeries{"x_m",
                                              "y_m",
                                              "theta_rad",
                                              "cov_xx",
                                              "cov_xt",
                                              "pose_nees",
                                              "loop_from",
                                              "loop_fate",
                                              "truth_x_m",
                                              "loop_nis",
                                              "time_s",
                                              "position_error_m",
                                              "update_keyframe"};

/// All that a store holds of some surveys, the first so many, but cost, sessions and jobs.
inline std::string content(const std::filesystem::path& folder, std::size_t surveys = 1000) {
  const ResultStore store = ResultStore::open(folder);
  std::ostringstream text;
  for (const RunRecord& run : store.runs()) {
    if (run.key.survey >= surveys) continue;
    text << run.key.cell << ' ' << run.key.survey << ' ' << run.key.trial << ' '
         << run.key.estimator << ' ' << run.outcome << ' ' << run.log_hash << '\n';
    for (const auto& [name, value] : run.metrics) {
      if (!is_cost_metric(name)) text << "  " << name << ' ' << exact(value) << '\n';
    }
    for (const std::string& name : kSeries) {
      const auto values = store.series(run.key, name);
      if (!values) continue;
      text << "  " << name;
      for (const double value : *values) text << ' ' << exact(value);
      text << '\n';
    }
  }
  return text.str();
}

}  // namespace fathom::test
