#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {

/// Two estimators, no sweep, unless a test gives it axes; of logs that every trial draws whole.
inline StudyDescription two_estimators(std::size_t trials) {
  StudyDescription study;
  study.title = "synthetic";
  study.alignment = "origin";
  study.trials = trials;
  study.estimators = {{"filter", "trajectory_iekf"}, {"graph", "ceres_pose_graph"}};
  study.metrics = {"mean_position_error_m", "total_ms"};
  study.configuration = {{"dataset.type", "simulated_log"}};
  return study;
}

inline RunRecord made_run(const std::string& estimator, std::size_t cell, std::size_t trial,
                          double error_m, double total_ms, std::size_t survey = 0) {
  RunRecord run;
  run.key = {cell, survey, trial, estimator};
  run.outcome = estimator == kDeadReckoning ? "" : "converged";
  run.metrics = {{"mean_position_error_m", error_m}};
  if (estimator != kDeadReckoning) run.metrics["total_ms"] = total_ms;
  return run;
}

inline void write_store(const std::filesystem::path& folder, const StudyDescription& study,
                        const std::vector<RunRecord>& runs) {
  ResultStore store = ResultStore::write(folder, study, "{}");
  for (const RunRecord& run : runs) store.add(run);
  store.finish();
}

/// What a study is whose configuration is this text.
inline StudyDescription described_study(const std::string& text) {
  return configure_study(settings_of(text), builtin_estimators()).description;
}

}  // namespace fathom::test
