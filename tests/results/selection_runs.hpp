#pragma once

#include <string>
#include <vector>

#include "fathom/results/selection.hpp"
#include "harness/small_study.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {

inline SelectionQuery asking(const std::vector<std::string>& requirements) {
  SelectionQuery query;
  for (const std::string& text : requirements) {
    query.requirements.push_back(parse_requirement(text));
  }
  return query;
}

inline Selection selected(const StudyDescription& study, const std::vector<RunRecord>& runs,
                          const SelectionQuery& query) {
  const TemporaryFolder folder;
  write_store(folder.path(), study, runs);
  return select_estimator(ResultStore::open(folder.path()), query);
}

// Errors of a cell's trials by estimator; the filter takes 10 ms and a bit, the graph 20 ms.
inline std::vector<RunRecord> runs_of(const std::vector<double>& filter_m,
                                      const std::vector<double>& graph_m, std::size_t cell = 0) {
  std::vector<RunRecord> runs;
  for (std::size_t trial = 0; trial < filter_m.size(); ++trial) {
    const double jitter_ms = 0.1 * static_cast<double>(trial);
    runs.push_back(made_run("filter", cell, trial, filter_m[trial], 10.0 + jitter_ms));
    runs.push_back(made_run("graph", cell, trial, graph_m[trial], 20.0 - 0.5 * jitter_ms));
  }
  return runs;
}

// Mean 0.10, largest deviation 0.02: the mean's interval is about 0.10 ± 0.008.
inline const std::vector<double> kAroundTenth{0.08, 0.09, 0.09, 0.10, 0.10,
                                              0.10, 0.11, 0.11, 0.12, 0.10};
inline const std::vector<double> kHalf(10, 0.5);

inline StudyDescription with_noise_axis(std::size_t trials) {
  StudyDescription study = two_estimators(trials);
  study.axes = {{"noise", "dataset.odometry.sigma_x_m", {"low", "high"}}};
  return study;
}

inline std::vector<RunRecord> together(std::vector<RunRecord> a, const std::vector<RunRecord>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace fathom::test
