#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// What the runs show of an estimator beside the best one of its cell.
enum class Standing {
  best,
  equivalent,  ///< the difference is within the margin, by two one-sided tests
  worse,       ///< the adjusted p is below 0.05, and the difference is beyond the margin
  not_shown    ///< neither; all of them where no verdict is given
};

/// One estimator beside the best one of a cell.
struct RankedEstimator {
  std::string name;
  MetricSummary summary;
  /// It minus the best, with an interval that holds together with those of the others
  /// (`Ranking::level`); nothing of the best itself, and where the two have no trial in common.
  std::optional<PairedDifference> difference;
  /// Of the signed-rank test against the best, adjusted after Holm over all pairs of the ranking:
  /// which one is the best is not known before.
  std::optional<double> p;
  Standing standing = Standing::not_shown;
};

/// An estimator without a metric in some trials in which others have it: its mean is of others.
struct PartlyMeasured {
  std::string name;
  std::size_t without = 0;  ///< of the trials
  std::size_t trials = 0;
};

/// The estimators of a cell by their means of one metric, the best first.
struct Ranking {
  std::string metric;
  std::vector<RankedEstimator> estimators;  ///< one or more
  std::vector<PartlyMeasured> left_out;
  std::set<TrialKey> trials;  ///< that the means are over
  double level = 0.95;        ///< of each interval: 1 − 0.05 / number of differences
  double margin = 0.0;        ///< differences up to it mean nothing; in the metric's unit
  std::size_t draws = 0;      ///< independent ones: surveys, or trials where these are drawn alone
  std::size_t fewest_draws = 0;     ///< with fewer no p can be below 0.05
  bool repeats_one_result = false;  ///< several trials, of one log, in which all say the same

  const RankedEstimator& best() const { return estimators.front(); }
  const RankedEstimator* find(const std::string& estimator) const;
  std::vector<const RankedEstimator*> standing(Standing which) const;
  /// Else all that is not the best is `not_shown`.
  bool gives_verdict() const { return draws >= fewest_draws; }
};

struct RankingOptions {
  std::vector<std::string> names = {};  ///< these alone; empty: all
  double margin = 0.01;                 ///< as a share of the best mean (`report.margin`)
};

/// Estimators that failed no run and have the metric in every trial that all have run and one has
/// it in; of a cost over the trials in which all have it. Means are over these trials. Dead
/// reckoning is none. Nothing where none is left, of a metric that does not say which of its values
/// is better, and with a no_ranking_text. The best is the one with the best mean, of those that are
/// nearer to it than `least_difference` the first of the study (of a cost of equal ones alone).
///
/// Of k estimators that are exchangeable in every draw, one or more are called worse in at most 5 %
/// of studies: the signed-rank test is exact then, and Holm's adjustment over all k (k − 1) / 2
/// pairs holds whichever is the best. Equivalent is what intervals of level
/// 1 − 0.05 / (k − 1) of its metric less 1 ± margin times that of the best show on either side of
/// 0. The margin is at least what a figure of the unit can mean. Of surveys that are drawn one says
/// nothing of others: its trials give no verdict.
std::optional<Ranking> ranking(const CellResults& cell, const std::string& metric,
                               const RankingOptions& options = {});

/// Below it a difference means nothing, whatever the means: no reference knows a position to a
/// micrometre, and no clock a run to a microsecond. In the metric's unit.
double least_difference(const std::string& metric);

/// The number of draws from which on a difference of one of so many estimators can be shown.
std::size_t fewest_draws(std::size_t estimators);

/// Whether a metric is F, or what it is above its optimum.
bool is_of_optimum(const std::string& metric);

/// Why estimators of a cell are not ranked by a metric, without a full stop; empty where they may
/// be. F and what it is above its optimum say something of an estimator where all measurements fit
/// each other and all estimators minimise the same F, and else rank those best that keep false
/// loops.
std::string no_ranking_text(const CellResults& cell, const std::string& metric);

/// The same of the first cell that has a reason.
std::string no_ranking_text(const StudyResults& results, const std::string& metric);

/// By which estimators are ranked: the first of the study's metrics that is no cost, says which of
/// its values is better, that a cell has, and by which each may be ranked.
struct RankingMetric {
  std::optional<std::string> name;
  std::vector<std::string> passed_over;  ///< a sentence for each before it, with the reason
};
RankingMetric ranking_metric(const StudyResults& results);

}  // namespace fathom
