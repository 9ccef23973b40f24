#pragma once

#include <list>
#include <stdexcept>
#include <string>
#include <vector>

#include "fathom/estimation/registry.hpp"
#include "fathom/harness/guarded_estimator.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom::conformance {

/// A clause says nothing of this estimator; the text is the reason.
struct NotApplicable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The estimator that a clause is about. What it makes lives as long as itself, so that no fault is
/// lost.
class Subject {
 public:
  explicit Subject(const EstimatorEntry& entry);

  GuardedEstimator& make(const StartPose& start = {}, const EstimatorValues& values = {},
                         SolveMode mode = SolveMode::incremental);
  /// Of a whole log, which it has been given and has finished.
  GuardedEstimator& solved(const MeasurementLog& log, const EstimatorValues& values = {});
  /// The same in batch mode, from where stretches between holes are put together.
  GuardedEstimator& solved_in_batch(const MeasurementLog& log, const EstimatorValues& values);

  bool has(const std::string& option) const;
  bool can_batch() const { return entry_.can_batch; }
  /// NotApplicable where the estimator has no such option, or no batch mode.
  void need(const std::string& option) const;
  void need_batch() const;

  /// Values with which it stops at its optimum and not before, of the options that it has.
  EstimatorValues to_the_optimum(const std::string& tolerance = "1e-13") const;
  /// The robust losses to choose from, `none` left out.
  std::vector<std::string> losses() const;

  /// The first fault of all that was made; empty: none.
  std::string fault() const;

 private:
  EstimatorEntry entry_;
  std::list<GuardedEstimator> made_;
};

EstimatorValues value(const std::string& key, const std::string& text);

/// Gives a whole log to an estimator; the worst outcome.
Outcome feed(Estimator& estimator, const MeasurementLog& log,
             std::vector<LoopDecision>* decisions = nullptr);

}  // namespace fathom::conformance
