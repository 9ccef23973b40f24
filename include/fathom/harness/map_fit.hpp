#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/evaluation/run.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// NIS, eᵀ Ω e, of measurements of three rows, at a map.
struct NisSpread {
  std::size_t count = 0;
  double mean = 0.0;
  double median = 0.0;  ///< 0.79 of the mean, where a χ² is scaled
  double largest = 0.0;

  double median_to_mean() const { return mean > 0.0 ? median / mean : 1.0; }
};

/// Why dead reckoning and loops do not fit each other, as far as loops say: by how they miss.
enum class StepBlame {
  unclear,
  loops,       ///< most loops fit and few do not: these are wrong and bend the steps
  covariance,  ///< all loops miss alike, or fit: the covariance of dead reckoning is too small
  slips        ///< loops fit, and so do most steps
};

/// How the measurements of a log agree with each other, and an estimate with them.
struct MapFit {
  double chi2 = 0.0;                     ///< F of the estimate
  std::optional<double> chi2_used = {};  ///< of the measurements that it used (Run::chi2_used)
  double absolute_left_out = 0.0;        ///< of the rest, what is of absolute measurements
  double chi2_optimum = 0.0;             ///< F of the batch optimum
  /// The same with registrations' covariances as they are of each alone (RelativePose::alone), as
  /// are all parts of it below; absent: the same.
  std::optional<double> chi2_alone = {};
  double mean_repeats = 1.0;         ///< RelativePose::repeats of registrations
  double steps_at_optimum = 0.0;     ///< the part of it that is of dead reckoning
  double absolute_at_optimum = 0.0;  ///< the part that is of absolute measurements
  double degrees_of_freedom = 0.0;   ///< of the optimum (degrees_of_freedom)
  double unknowns = 0.0;             ///< that are determined (determined_unknowns)
  NisSpread steps = {};              ///< at the optimum, holes left out
  NisSpread registrations = {};      ///< likewise
  /// Whether the estimator considers errors that registrations share, so that its gains minimise no
  /// F and leave it above the optimum.
  bool considers_shared_errors = false;
  /// Of registrations at the optimum: root mean squares of their residuals, and of what their
  /// covariances say.
  double registration_rms_m = 0.0;
  double registration_rms_rad = 0.0;
  double registration_sigma_m = 0.0;
  double registration_sigma_rad = 0.0;

  /// F per degree of freedom at the optimum: 1 is expected of right loops and covariances.
  double per_degree_of_freedom() const { return alone_at_optimum() / degrees_of_freedom; }
  double alone_at_optimum() const { return chi2_alone.value_or(chi2_optimum); }

  /// Whether F of the estimate lies above its optimum by no more than 99 of 100 draws from the
  /// posterior would: F − F* is χ² with as many degrees of freedom as there are unknowns. Where F
  /// per degree of freedom is above 1 already, all covariances are taken to be so much larger. One
  /// that considers shared errors does not fit where F is beyond all that its gains explain.
  bool estimate_fits() const;

  /// The largest NIS that chance leaves a registration, in one of a million logs; covariances are
  /// taken as in estimate_fits.
  double largest_nis_by_chance() const;

  /// Whether some registration contradicts the others beyond chance: few false ones among many
  /// right ones leave F per degree of freedom moderate.
  bool is_one_contradicted() const { return registrations.largest > largest_nis_by_chance(); }

  bool is_far_above_chance() const { return per_degree_of_freedom() > 3.0; }

  /// Whether measurements do not fit each other, far beyond chance.
  bool measurements_disagree() const { return is_far_above_chance() || is_one_contradicted(); }

  /// Where most of F is of dead reckoning, what for.
  StepBlame step_blame() const;

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

/// Whether `shared_errors` of an estimator is this word, of a log that tells them.
bool takes_shared_errors_as(const std::string& word, const MeasurementLog& log,
                            const EstimatorConfiguration& estimator,
                            const EstimatorRegistry& registry);

/// What of a map looks wrong: an estimate that does not fit its measurements, or measurements that
/// do not fit each other: for covariances that are too small or wrong loops, unless the set-up is
/// known to be wrong.
std::vector<std::string> map_remarks(const MapFit& fit, const std::string& estimator,
                                     const std::string& solver, bool set_up_is_wrong = false);

/// Of an estimator that takes registrations as independent although the log tells what those of a
/// picture share: whether they agree so much better than their covariances say that it shows.
std::optional<std::string> sharing_remark(const MapFit& fit, const std::string& estimator);

}  // namespace fathom
