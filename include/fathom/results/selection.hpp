#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/paired.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

enum class Relation { at_most, below, at_least, above };

/// A bound that a user sets on a metric, in the metric's unit.
struct Requirement {
  std::string metric;
  Relation relation = Relation::at_most;
  double bound = 0.0;

  bool holds(double value) const;
  bool is_upper_bound() const;
  /// "update_ms.p95 <= 20".
  std::string text() const;
};

/// Reads `METRIC OP NUMBER`, OP one of <=, <, >=, >; blanks allowed. Throws InputError with an
/// example.
Requirement parse_requirement(const std::string& text);

/// What a user asks of a study.
struct SelectionQuery {
  std::vector<Requirement> requirements;
  std::string objective = "total_ms";  ///< the metric that decides among those that meet them
  bool maximise = false;               ///< the objective; else the least is best
  /// `AXIS=LABEL`, the axis by name or key: the cells looked at. Several labels of one axis are
  /// alternatives; an axis that is not named is not restricted.
  std::vector<std::string> where;
  double allowed_failures = 0.0;  ///< share of an estimator's runs, 0 to 1, that may have failed
};

/// A mean over trials, of several surveys over the surveys' means, with the 95 % bootstrap interval
/// of it; none where a cell has one trial only.
struct TrialMean {
  std::size_t count = 0;  ///< of runs
  double mean = 0.0;
  std::optional<Interval> interval;
};

/// From good to bad. `not_shown`: the mean meets the requirement, its interval does not.
enum class Verdict { meets, not_shown, fails, not_measured };
std::string name_of(Verdict verdict);

/// How an estimator does by one requirement, in the cell where it does worst.
struct Judgement {
  Verdict verdict = Verdict::not_measured;
  std::size_t cell = 0;
  std::optional<TrialMean> value;  ///< nothing where it was not measured
};

/// The evidence of one estimator.
struct EstimatorEvidence {
  std::string name;
  std::vector<Judgement> judgements;  ///< one per requirement
  /// Mean over the cells of the cells' means; of those that meet all over the trials in which all
  /// of these have it.
  std::optional<TrialMean> objective;
  std::size_t runs = 0;    ///< in the cells looked at
  std::size_t failed = 0;  ///< of these; never part of a mean
  bool has_too_many_failures = false;
  bool meets_all = false;  ///< the requirements, and not too many failures
  /// A cell of which no trial is left that it and the others that meet all have the objective in:
  /// then it is in no comparison.
  std::optional<std::size_t> shares_nothing_in;
};

/// The chosen estimator against the second best of those that meet all requirements.
struct Lead {
  std::size_t runner_up = 0;                   ///< place in `Selection::estimators`
  std::optional<PairedDifference> difference;  ///< of the objective, chosen − runner-up
  /// The interval of the difference leaves 0 out, Wilcoxon's p is at most 0.05, and ranks favour
  /// the same one; of several surveys all are over the surveys.
  bool is_significant = false;
};

struct Selection {
  std::vector<std::size_t> cells;  ///< looked at: asked for, and with runs
  std::size_t cells_asked = 0;
  std::size_t fewest_trials = 0;  ///< that all estimators have, of all surveys, over the cells
  std::size_t most_trials = 0;
  std::size_t surveys = 0;  ///< that these trials are of
  /// Of these trials, over the cells, that one of those compared failed or has no objective in: the
  /// objective is without them.
  std::size_t trials_left_out = 0;
  std::size_t fewest_shared = 0;  ///< trials of a cell that the objective is over
  std::string repeats;            ///< what they are, in words: "10 surveys × 10 trials"
  std::vector<EstimatorEvidence> estimators;  ///< as in the study
  std::optional<EstimatorEvidence> baseline;  ///< dead reckoning; never chosen
  std::optional<std::size_t> chosen;          ///< place in `estimators`
  std::optional<Lead> lead;                   ///< where more than one meets all
  std::vector<std::size_t> met_by_none;       ///< places of the requirements that nobody meets
  std::size_t nearest = 0;  ///< the estimator that misses least; the chosen one if there is one
  std::vector<std::string> remarks;  ///< what limits the evidence, a line each
};

/// Chooses among the estimators of a study. In each cell the trials count that all estimators have
/// a run of; cells without such a trial are left out with a remark. A requirement is met where the
/// 95 % interval of the mean (of a single trial: the value) lies on its right side in every cell.
/// Trials that repeat one measurement log are one result (DistinctValues).
/// Throws InputError on a metric or axis that the study does not have, with the nearest that it
/// has, and on a study without a trial that all estimators have.
Selection select_estimator(const ResultStore& store, const SelectionQuery& query);

}  // namespace fathom
