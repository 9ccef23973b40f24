#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// A standard deviation that nobody stated: of the altitude, or of roll and of pitch, of the
/// pictures it governs. Or of what a registration's own covariance leaves out (relief through the
/// lever, distortion), in units of that covariance, which becomes (1 + σ²) own.
struct VarianceComponent {
  enum class Part {
    altitude,  ///< m
    tilt,      ///< rad; roll and pitch have one
    own        ///< in standard deviations of each told registration
  };
  Part part = Part::tilt;
  /// By keyframe, whether its picture is governed; empty: all are. A picture whose sensor states
  /// the part is not, and keeps what its registrations tell.
  std::vector<bool> governed = {};
  /// Where the search ends. Beyond 1 rad a tilt does not act as G says; 100 m is any altitude.
  double greatest() const { return part == Part::tilt ? 1.0 : 100.0; }
  bool is_of_pictures() const { return part != Part::own; }
};

struct VarianceOptions {
  double probability = 0.95;  ///< of the intervals
  /// By registration, in order of arrival, whether it is used; empty: all are. A registration that
  /// a robust estimator or a gate found to be wrong belongs left out.
  std::vector<bool> used = {};
  /// Registrations that all the others contradict are left out, the worst of each neighbourhood
  /// first, and all begins anew without them. This is the probability, if all are right, that any
  /// is; 0 leaves none out. See VarianceEstimate::left_out_chi2.
  double contradiction = 0.01;
  /// The poses are moved to their optimum and the log is linearised there, so many times at most.
  int max_linearisations = 10;
  /// Change of the deviance −2ℓ that a step of the search or a new linearisation leaves alone. An
  /// interval ends where it is met to 1000 times this, 1e-3 of 3.84.
  double tolerance = 1e-6;
  int threads = 1;  ///< at most; no result depends on it
  /// Asked with the σ of all components, perhaps by several threads, whether intervals and ratios
  /// are wanted; none: they are. Without them `sigma` is where the search ended, `low` and the
  /// ratios are NaN, and `high` says no more than whether the survey bounds σ.
  std::function<bool(std::span<const double>)> wants_intervals = {};
};

/// What the survey says of one component.
struct SigmaEstimate {
  double sigma = 0.0;  ///< m or rad; 0 where the likelihood falls from there on
  /// Profile likelihood interval; low is 0 where nothing contradicts that, high may be infinite.
  double low = 0.0;
  double high = std::numeric_limits<double>::infinity();
  /// Likelihood ratio −2 (ℓ(0) − ℓ(σ)) against 0, and against what the registrations tell; each
  /// with the other component at its best. Of 0 it is ½ χ²₀ + ½ χ²₁ (Self and Liang 1987), of told
  /// ones χ²₁.
  double against_zero = 0.0;
  double against_told = 0.0;
  std::size_t pictures = 0;  ///< governed, in registrations that are used and respond to them

  /// Whether the survey bounds it at all.
  bool is_determined() const { return high < std::numeric_limits<double>::infinity(); }
};

struct VarianceEstimate {
  enum class Outcome {
    converged,
    iteration_limit,    ///< the linearisations did not settle
    nothing_told,       ///< no registration in use tells what governed pictures share
    numerical_failure,  ///< a NaN, or poses that the measurements do not tie down
  };
  Outcome outcome = Outcome::nothing_told;
  std::vector<SigmaEstimate> components;  ///< as asked for; meaningless after the last two
  double log_likelihood = 0.0;            ///< restricted, without its (N − p)/2 · log 2π
  /// rᵀ C⁻¹ r at the optimum and N − p, its mean if all covariances are right: the ratio is 1 as
  /// far as the components could make it so. Far above: false loops, or own covariances too small.
  double chi2 = 0.0;
  double degrees_of_freedom = 0.0;
  std::size_t registrations = 0;  ///< that tell their errors apart and are used
  std::vector<bool> used;         ///< by registration in order of arrival
  /// By registration, its distance from what all the others predict of it, in standard deviations,
  /// squared: χ² of 3 degrees of freedom where it is right; NaN where it is not used.
  std::vector<double> left_out_chi2;
  std::vector<Pose> trajectory;  ///< the optimum of the poses, where all was linearised last
};

/// Restricted maximum likelihood (Patterson and Thompson 1971; Harville 1977) of standard
/// deviations of what the registrations of a picture share (docs/variance_components.md). Poses are
/// fixed effects, n of the pictures are random ones, and all other covariances are taken as told:
/// of steps, absolute measurements, the start, a registration's own. Holes are not counted.
///
/// `trajectory`, by keyframe, is where to begin, near the optimum. One or two components, which
/// govern different errors. Errors are Gaussian: one false loop is taken for tilt, so that what is
/// false must be left out (VarianceOptions::used, contradiction). The interval holds the true value
/// in 95 of 100 surveys, up to 97.5 near 0.
///
/// Throws InputError where sizes do not fit or two components govern the same.
VarianceEstimate estimate_variance(const MeasurementLog& log, std::span<const Pose> trajectory,
                                   std::span<const VarianceComponent> components,
                                   const VarianceOptions& options = {});

/// ℓ = −½ (log|C| + log|Jᵀ C⁻¹ J| + rᵀ P r) at one σ a component, linearised at the trajectory; NaN
/// where it cannot be had. Optionally its derivatives by log σ.
double restricted_log_likelihood(const MeasurementLog& log, std::span<const Pose> trajectory,
                                 std::span<const VarianceComponent> components,
                                 std::span<const double> sigmas,
                                 const VarianceOptions& options = {},
                                 Eigen::VectorXd* likelihood_log_sigma = nullptr);

}  // namespace fathom
