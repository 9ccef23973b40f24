#pragma once

#include "estimators/sparse_gauss_newton/loop_graph.hpp"
#include "fathom/core/options.hpp"

namespace fathom::sparse_gauss_newton {

/// How `loss: truncated` judges loops (docs/robustness.md). The defaults were found on circles,
/// ring and intel with false loops of three kinds (`benchmarks/wrong_loops`) and tried on CSAIL,
/// manhattan, MIT and M3500, unless another source is given.
struct LoopJudgement {
  /// In squared scales c², of the χ² left out: a loop or a group beyond it is rejected, and a
  /// weight falls from 1 at `reject_at` − 1 to 0 here. 1.5 puts the weight of one half at c².
  double reject_at = 1.5;
  /// A false loop spoils the figures of its neighbours, so few are rejected at a time: those with
  /// this share of the largest χ² at least.
  double worst_share = 0.5;
  /// A loop that was rejected so often is not readmitted: it would go on for ever.
  int max_rejections = 2;
  /// A group below this share of c² is far from rejection, and is not judged again: three solves.
  double settled_group_share = 0.5;
  /// A group is rejected if each of its loops has more than this share of c² against it. Loops of
  /// the same pictures share errors that their covariances do not know, so that the χ² of a right
  /// group grows with its loops. Fitted on a survey of the study wrong_loops with the defaults of
  /// the front end: a right group of 1423 loops had 0.005 c² each.
  double group_loop_share = 0.1;

  /// A rejected loop is a candidate while its χ² is within so many c²; the others would only fill
  /// the factor.
  double candidate_reach = 1e3;
  /// Where few loops hold the map, or one is new, also if the drift of dead reckoning could explain
  /// its residual within so many c².
  double drift_reach = 4.0;
  /// Few: less than this share of all loops.
  double few_share = 1.0 / 3.0;

  /// c² is so many times this quantile of the χ² left out, over `reject_at`, if that is less than
  /// the default. Real loops have heavier tails than χ²₃: the largest of a set is 1.1 to 9.3 times
  /// its 90 % quantile (the table in docs/robustness.md).
  double scale_factor = 10.0;
  double scale_quantile = 0.9;
  /// From so many loops on: fewer have no such quantile.
  int scale_loops = 10;
  /// Of the default c² at least this share: agreement beyond it is no news.
  double least_scale_share = 0.01;

  /// Keyframes between two ends that belong to one place. The groups of Vertigo's false loops
  /// (Sünderhauf and Protzel 2012) are runs of neighbours.
  int group_reach = 5;
  /// Two lost loops agree within so many c²: two measurements and the motions between them differ,
  /// not one.
  double lost_group_slack = 4.0;
  /// So many lost groups are trusted in turn, the largest first.
  int hypotheses = 3;
  /// Weight under Geman-McClure from which a loop is in at first: one half is early to reject it.
  double first_weight = 0.25;

  /// Searches with a new choice of candidates, judgements in one of them, and rounds of weights, at
  /// most; they end by themselves well before.
  int passes = 10;
  int rounds = 60;
  int weight_rounds = 20;
  /// Weights have settled when none changes by more; a smaller one is zero.
  double weight_tolerance = 0.01;

  /// Solves on the way need not be good: of a judgement, and of the leading Geman-McClure.
  SolveLimits judged_solve{20, 1e-6};
  SolveLimits leading_solve{50, 1e-4};

  void describe(OptionTable& table);
  bool operator==(const LoopJudgement&) const = default;
};

}  // namespace fathom::sparse_gauss_newton
