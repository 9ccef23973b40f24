#pragma once

#include <string>
#include <vector>

#include "ranking.hpp"

namespace fathom {

/// An estimator that is ranked.
struct Contender {
  const EstimatorResults* one = nullptr;
  MetricSummary summary;  ///< over the trials to rank by, the same of all

  double mean() const { return summary.moments.mean; }
};

/// Whether an estimator that failed no run has a metric; dead reckoning is none. `names`: these
/// alone; empty: all.
bool is_ranked(const EstimatorResults& one, const std::string& metric,
               const std::vector<std::string>& names = {});

/// Those of a cell, the best first. Who lacks the metric in some of the trials to rank by is added
/// to `left_out` instead.
std::vector<Contender> contenders_of(const CellResults& cell, const Metric& metric,
                                     const std::vector<std::string>& names,
                                     std::vector<PartlyMeasured>& left_out);

/// Why a cell has none, a sentence.
std::string nobody_is_ranked_text(const CellResults& cell, const std::string& metric);

}  // namespace fathom
