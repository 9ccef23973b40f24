#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/evaluation/costs.hpp"
#include "fathom/evaluation/relative_consistency.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/decision.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// One estimator's estimate from a log: trajectory, decisions, costs, and how it ended.
struct Run {
  std::vector<Pose> trajectory;  ///< of the keyframes, world axes
  /// Of every keyframe; absent where not asked for or not to be had.
  std::optional<std::vector<Eigen::Matrix3d>> covariances;
  Outcome outcome = Outcome::converged;  ///< the worst of all updates
  /// How the estimator broke its contract (GuardedEstimator), one line; the outcome is
  /// `numerical_failure` then, or `crashed` where a program ended. Or how its process ended. Empty:
  /// neither.
  std::string fault;
  /// Of updates, by Outcome; no update has one from `crashed` on.
  std::array<std::size_t, 4> outcome_counts{};
  std::vector<LoopDecision> loops;  ///< in the order of the log; a NIS that is there is finite
  /// The final weight of each (Estimator::loop_weights); 0 of those that are not used.
  std::vector<double> loop_weights;
  std::vector<AbsoluteDecision> absolute;  ///< likewise
  std::vector<double> absolute_weights;
  int iterations = 0;
  /// Which F the estimator minimises (Estimate::estimates_shared_errors): all below is of that one.
  RegistrationErrors errors = RegistrationErrors::independent;
  /// Of the last update, where the estimator says so (UpdateReport).
  std::optional<double> gradient_norm;
  std::optional<bool> is_local_minimum;
  Costs costs;
  /// Those asked for, each with its covariances where they are to be had.
  std::vector<JudgedMotions> motions;
  double chi2_initial = 0.0;  ///< F at the initial guess: dead reckoning, or the file's
  /// Σ ρ(eᵀ Ω e) over what the estimator used: what was rejected left out, loss applied.
  double chi2_used = 0.0;
  double absolute_chi2_used = 0.0;  ///< of it, absolute measurements and an uncertain start

  /// visit(member) for each member, once: for whoever has to take them all.
  template <class Visit>
  static void each(Visit&& visit) {
    visit(&Run::trajectory);
    visit(&Run::covariances);
    visit(&Run::outcome);
    visit(&Run::fault);
    visit(&Run::outcome_counts);
    visit(&Run::loops);
    visit(&Run::loop_weights);
    visit(&Run::absolute);
    visit(&Run::absolute_weights);
    visit(&Run::iterations);
    visit(&Run::errors);
    visit(&Run::gradient_norm);
    visit(&Run::is_local_minimum);
    visit(&Run::costs);
    visit(&Run::motions);
    visit(&Run::chi2_initial);
    visit(&Run::chi2_used);
    visit(&Run::absolute_chi2_used);
  }
};

/// A measurement is kept if its final weight is above one half.
inline bool is_kept(double weight) {
  return weight > 0.5;
}

}  // namespace fathom
