#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "fathom/datasets/data_set.hpp"

namespace fathom {

/// One axis of a study's sweep: a key and the values that it takes, in order.
struct StudyAxis {
  std::string name;                      ///< for tables; the key unless the study names it
  std::string key;                       ///< of the configuration
  std::vector<std::string> labels;       ///< of the values, for tables; may change afterwards
  std::vector<std::string> values = {};  ///< as written; where empty, the labels are the values

  const std::vector<std::string>& written_values() const {
    return values.empty() ? labels : values;
  }
};

struct StudyEstimator {
  std::string name;
  std::string type;
};

/// What selected the loop candidates of a cell whose association is shared.
struct LoopSelector {
  enum class Kind {
    unknown,       ///< nothing did, or the study does not say
    ground_truth,  ///< truth itself
    automatic,     ///< ground truth, where there is no such an estimate
    outsider,      ///< the estimate of one that is not compared
    contender      ///< the estimate of one that is
  };
  Kind kind = Kind::unknown;
  std::string estimator;  ///< of an estimate: its type or name
};

/// What a study is, apart from its results. Cells are the Cartesian product of the axes, the last
/// axis running fastest; without axes there is one cell.
struct StudyDescription {
  std::string title;
  std::string alignment;    ///< of errors: none, origin or se2; of the cells that sweep no other
  std::size_t surveys = 1;  ///< asked for, per cell
  std::size_t trials = 1;   ///< asked for, per survey
  std::vector<StudyAxis> axes;
  std::vector<StudyEstimator> estimators;
  std::vector<std::string> metrics;  ///< for tables and charts, in this order
  double margin = 0.01;              ///< of equivalence, as a share of the best mean
  /// Every key that results depend on, with its value; the sweep's too. Not surveys, trials or
  /// jobs.
  std::vector<std::pair<std::string, std::string>> configuration;
  /// Every file of the data sets with the hash of its content.
  std::vector<std::pair<std::string, std::string>> data;

  std::size_t cell_count() const;
  /// The index on each axis of a cell.
  std::vector<std::size_t> places_of(std::size_t cell) const;
  /// "separation 5, noise level 2"; "all" without axes.
  std::string label_of(std::size_t cell) const;
  /// How a cell's loop candidates were selected, `shared` or `own`; empty where there are none.
  std::string association_of(std::size_t cell) const;
  LoopSelector selector_of(std::size_t cell) const;
  /// The same in words: "ground truth", "the estimate of ekf, a contender"; empty where unknown.
  std::string selected_by(std::size_t cell) const;
  /// Whether an estimator of a cell considers errors that registrations share, so that it minimises
  /// no F.
  bool considers_shared_errors(std::size_t cell, const std::string& estimator) const;
  /// How a cell's estimates were aligned for their errors.
  std::string alignment_of(std::size_t cell) const;
  /// What of a cell's data set is drawn again. Of a type that is not known: surveys, which claims
  /// the fewest independent draws that repeat.
  Repetition repetition_of(std::size_t cell) const;
};

/// What a figure is over: "10 surveys × 10 trials", of recorded pictures "one set of pictures, 10
/// trials", of logs that are drawn whole "10 trials", of a recorded graph "one graph, 10 trials".
std::string repeats_text(Repetition repetition, std::size_t surveys, std::size_t trials);

/// What intervals over the trials of one survey, or of what was recorded once, do not speak of;
/// empty where trials draw everything.
std::string limits_of_one_survey(Repetition repetition);

/// Of so many surveys and trials in all those that are independent draws, pictures included: what a
/// χ² interval may count. Trials over the same pictures share the errors of their registrations.
std::size_t independent_draws(Repetition repetition, std::size_t surveys, std::size_t trials);

/// The name under which dead reckoning, the baseline, stands among the estimators' runs. It is no
/// estimator of the registry, and none may be called so.
inline constexpr const char* kDeadReckoning = "dead_reckoning";

/// Words of `association.reference` beside the names of estimators, which none may be called.
inline constexpr const char* kGroundTruth = "ground_truth";
inline constexpr const char* kAutomatic = "automatic";

}  // namespace fathom
