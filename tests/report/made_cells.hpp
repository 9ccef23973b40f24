#pragma once

#include <string>
#include <vector>

#include "fathom/evaluation/clustered.hpp"
#include "src/report/study_results.hpp"
#include "src/report/verdict.hpp"

namespace fathom::test {

inline constexpr const char* kError = "mean_position_error_m";

/// An estimator with one run a survey, or a trial of one survey, and these errors.
inline EstimatorResults made(const std::string& name, const std::vector<double>& errors,
                             bool of_surveys = false) {
  EstimatorResults one;
  one.name = name;
  ClusteredValues values;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    RunRecord run;
    run.key = {0, of_surveys ? i : 0, of_surveys ? 0 : i, name};
    run.outcome = "converged";
    run.metrics = {{kError, errors[i]}, {"loop_closures", 7.0}};
    one.runs.push_back(run);
    values[run.key.survey].push_back(errors[i]);
  }
  one.done = errors.size();
  one.outcomes["converged"] = errors.size();
  if (errors.empty()) return one;
  MetricSummary& summary = one.metrics[kError];
  summary.moments = *moments(errors);
  summary.interval = hierarchical_interval(values);
  summary.surveys = values.size();
  return one;
}

/// A cost that is the same in all its runs.
inline EstimatorResults costing(EstimatorResults one, double total_ms) {
  for (RunRecord& run : one.runs) run.metrics["total_ms"] = total_ms;
  Moments& cost = one.metrics["total_ms"].moments;
  cost.count = one.runs.size();
  cost.mean = total_ms;
  return one;
}

inline CellResults cell_of(std::vector<EstimatorResults> estimators) {
  CellResults cell;
  cell.label = "all";
  cell.surveys = 1;
  for (const EstimatorResults& one : estimators) {
    cell.trials = std::max(cell.trials, one.runs.size());
  }
  cell.estimators = std::move(estimators);
  return cell;
}

inline const std::vector<double> kBest{0.010, 0.012, 0.009, 0.011, 0.010, 0.011, 0.0105, 0.0105};
inline const std::vector<double> kAlike{0.011, 0.011, 0.008, 0.013, 0.009, 0.0115, 0.0105, 0.0107};
inline const std::vector<double> kWorse{0.013,  0.0152, 0.0121, 0.0141,
                                        0.0130, 0.0142, 0.0136, 0.0137};

inline StudyResults study_of(std::vector<CellResults> cells, std::size_t surveys,
                             std::size_t trials) {
  StudyResults results;
  results.study.surveys = surveys;
  results.study.trials = trials;
  results.study.metrics = {"anees", kError, "total_ms"};
  results.metrics = results.study.metrics;
  results.cells = std::move(cells);
  return results;
}

// Eight surveys of one trial each.
inline CellResults surveyed(std::vector<EstimatorResults> estimators) {
  CellResults cell = cell_of(std::move(estimators));
  cell.surveys = cell.trials;
  return cell;
}

inline EstimatorResults eight(const std::string& name, const std::vector<double>& errors,
                              double total_ms = 1.0) {
  return costing(made(name, errors, true), total_ms);
}

inline std::vector<std::string> doubts_of_one(const CellResults& cell) {
  return study_verdict(study_of({cell}, 8, 1)).doubts;
}

}  // namespace fathom::test
