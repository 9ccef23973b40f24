#pragma once

#include <set>
#include <string>
#include <vector>

#include "ranking.hpp"

namespace fathom {

/// An estimator that is ranked.
struct Contender {
  const EstimatorResults* one = nullptr;
  double mean = 0.0;  ///< over the trials to rank by
};

/// Those of a cell that are ranked by a metric, and over what. All that says which is better rests
/// on these: verdict, ranks, Pareto front, regime map and choice of the cheapest.
struct Contenders {
  std::vector<Contender> order;          ///< the best first, of equal ones as in the study
  std::vector<PartlyMeasured> left_out;  ///< who lacks the metric in some of the trials
  std::set<TrialKey> trials;             ///< to rank by, the same of all

  const Contender* find(const std::string& estimator) const;
};

/// Whether an estimator that failed no run has a metric; dead reckoning is none. `names`: these
/// alone; empty: all.
bool is_ranked(const EstimatorResults& one, const std::string& metric,
               const std::vector<std::string>& names = {});

/// Nothing of a metric that does not say which of its values is better, and with a no_ranking_text.
Contenders contenders_of(const CellResults& cell, const std::string& metric,
                         const std::vector<std::string>& names = {});

/// Why a cell has none, a sentence.
std::string nobody_is_ranked_text(const CellResults& cell, const std::string& metric);

}  // namespace fathom
