#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"

namespace fathom {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

/// What is estimated of a set-up: the logarithm of the factor that makes registered motions as long
/// as dead reckoning's, the mounting's yaw and lever arm (m), and what is to be added to the time
/// stamps of dead reckoning (s).
struct SetUpParameters {
  double log_scale = 0.0;
  double yaw_rad = 0.0;
  double lever_x_m = 0.0;
  double lever_y_m = 0.0;
  double time_offset_s = 0.0;

  Vector5 vector() const { return {log_scale, yaw_rad, lever_x_m, lever_y_m, time_offset_s}; }
  static SetUpParameters from_vector(const Vector5& v) { return {v(0), v(1), v(2), v(3), v(4)}; }
};

/// How well registrations fit dead reckoning under some format of it.
struct SetUpFit {
  SetUpParameters value;
  Matrix5 covariance = Matrix5::Zero();
  std::size_t motions = 0;   ///< that dead reckoning covers
  double sigma_m = 0.0;      ///< scale of a residual, x or y
  double sigma_rad = 0.0;    ///< of the heading
  double log_density = 0.0;  ///< of all motions, up to a constant
  /// The same where it was highest on the way: a clock that the motions do not tell drifts off.
  double most_log_density = 0.0;
  double median_m = 0.0;  ///< length of a reckoned motion
  /// Registered over reckoned length by regression on reckoned motions, where exp(−log_scale) is
  /// that on registered ones. Errors of registrations make the latter too large, of dead reckoning
  /// the former too small: the true one lies between.
  Estimated least_scale;
  /// By motion covered: which one, and the reckoned length over the registered one.
  struct Motion {
    std::size_t index = 0;
    double length_ratio = 1.0;
  };
  std::vector<Motion> each;
};

/// Where mounting and clock are expected, and how far they may be off: keeps what the motions do
/// not tell where it is configured.
struct SetUpPrior {
  SetUpParameters mean;
  double sigma_lever_m = 3.0;
  double sigma_time_s = 10.0;

  Vector5 information() const {
    constexpr double kNone = 1e-12;
    const double of_lever = 1.0 / (sigma_lever_m * sigma_lever_m);
    return {kNone, kNone, of_lever, of_lever, 1.0 / (sigma_time_s * sigma_time_s)};
  }
};

/// Most likely with residuals of Student's t (docs/calibration.md): iteratively reweighted least
/// squares from the best of several time offsets. Nothing where dead reckoning covers too few of
/// the motions.
std::optional<SetUpFit> fit_set_up(std::span<const SeenMotion> motions, const OdometryTrack& track,
                                   const SetUpPrior& prior);

}  // namespace fathom
