#pragma once

#include <string>

#include "fathom/results/result_store.hpp"

namespace fathom::test {

inline StudyDescription description() {
  StudyDescription study;
  study.title = "two by three";
  study.alignment = "origin";
  study.trials = 2;
  study.axes = {{"separation", "front_end.keyframes.separation_frames", {"5", "10"}},
                {"noise", "dataset.odometry.covariance", {"none", "low", "high"}}};
  study.estimators = {{"iterated", "trajectory_iekf"}, {"plain", "ekf"}};
  study.metrics = {"mean_position_error_m", "anees"};
  study.configuration = {{"association.mode", "own"}, {"seed", "1"}};
  return study;
}

inline RunRecord record(std::size_t cell, std::size_t trial, const std::string& estimator) {
  RunRecord run;
  run.key = {cell, 0, trial, estimator};
  run.outcome = "converged";
  run.log_hash = "00ff";
  run.jobs = 2;
  run.metrics = {{"mean_position_error_m", 0.1 + static_cast<double>(trial)}, {"total_ms", 3.5}};
  run.series = {{"x", {1.0, 1.0 / 3.0, -0.0}}, {"empty", {}}};
  return run;
}

}  // namespace fathom::test
