#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/evaluation/run.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// How the measurements of a log agree with each other, and an estimate with them.
struct MapFit {
  double chi2 = 0.0;                     ///< F of the estimate
  std::optional<double> chi2_used = {};  ///< of the measurements that it used (Run::chi2_used)
  double absolute_left_out = 0.0;        ///< of the rest, what is of absolute measurements
  double chi2_optimum = 0.0;             ///< F of the batch optimum
  double steps_at_optimum = 0.0;         ///< the part of it that is of dead reckoning
  double absolute_at_optimum = 0.0;      ///< the part that is of absolute measurements
  double degrees_of_freedom = 0.0;       ///< of the optimum (degrees_of_freedom)
  double unknowns = 0.0;                 ///< that are determined (determined_unknowns)
  /// Of registrations at the optimum: root mean squares of their residuals, and of what their
  /// covariances say.
  double registration_rms_m = 0.0;
  double registration_rms_rad = 0.0;
  double registration_sigma_m = 0.0;
  double registration_sigma_rad = 0.0;

  /// F per degree of freedom at the optimum: 1 is expected of right loops and covariances.
  double per_degree_of_freedom() const { return chi2_optimum / degrees_of_freedom; }

  /// Whether F of the estimate lies above its optimum by no more than 99 of 100 draws from the
  /// posterior would: F − F* is χ² with as many degrees of freedom as there are unknowns. Where F
  /// per degree of freedom is above 1 already, all covariances are taken to be so much larger.
  bool estimate_fits() const;

  /// Whether measurements do not fit each other, far beyond chance.
  bool measurements_disagree() const { return per_degree_of_freedom() > 3.0; }

  /// Whether most of F is of measurements that the estimator rejected or weighed down, and its
  /// optimum, which has all of them, does not fit them either: then that optimum says nothing of
  /// the map. Where it fits, they are right and the estimator lost them.
  bool leaves_out_most() const {
    return chi2_used && *chi2_used < 0.5 * chi2 && measurements_disagree();
  }
};

/// Nothing without registrations, or where nothing contradicts anything.
std::optional<MapFit> map_fit(const MeasurementLog& log, std::span<const Pose> estimate,
                              const BatchOptimum& optimum, const Run* run = nullptr);

/// What of a map looks wrong: an estimate that does not fit its measurements, or measurements that
/// do not fit each other: for covariances that are too small or wrong loops, unless the set-up is
/// known to be wrong.
std::vector<std::string> map_remarks(const MapFit& fit, const std::string& estimator,
                                     const std::string& solver, bool set_up_is_wrong = false);

/// Of an estimator that takes registrations as independent although the log tells what those of a
/// picture share: whether they agree so much better than their covariances say that it shows.
std::optional<std::string> sharing_remark(const MapFit& fit, const std::string& estimator);

}  // namespace fathom
