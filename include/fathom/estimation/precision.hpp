#pragma once

#include <limits>
#include <span>

#include <Eigen/Core>

#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/relative_pose.hpp"

/// What double precision carries of a measurement. Beyond it an update fails: it would end
/// somewhere, and its cost and covariances would be those of rounding.
namespace fathom {

/// A measurement is resolved if rounding the coordinates of its ends changes its eᵀ Ω e by less
/// than this, in squared sigmas: small beside the 3 that a right measurement has on average.
inline constexpr double kMostRoundingChi2 = 0.01;

/// Whether a measurement between these poses is resolved: whether its standard deviations stand out
/// from the last digit of the coordinates (1e-14 m at 100 m from the origin). NaN is not.
bool is_resolved(const RelativePose& measurement, const Pose& from, const Pose& to);

/// Whether each of these registrations is, at the estimate.
bool are_resolved(const TrajectoryView& estimate, std::span<const RelativePose> registrations);

/// A pivot of a Cholesky factor that is a smaller share of its diagonal element is what the
/// rounding of that element leaves (64 ε: the sum of a few dozen rounded terms), and says nothing.
inline constexpr double kLeastPivotShare = 64.0 * std::numeric_limits<double>::epsilon();

/// By how many times a measurement says more along one axis than along another: of positions in any
/// direction, and of the heading that is left with the position known to that without. 1 where all
/// are alike, about 10¹⁶ where the weakest is the rounding of the matrix; 1 of a semi-definite
/// matrix, whose weakest axis says nothing.
double own_spread(const Eigen::Matrix3d& information);

/// How different the information of the measurements of a graph is. Normal equations add them up,
/// and what one says is lost in the rounding of another that says 10¹⁶ times as much.
class InformationSpread {
 public:
  /// A hole's declared covariance is no measurement, and is not counted.
  void add(const RelativePose& measurement);

  /// Whether the pivots of the factor have to be looked at (kLeastPivotShare): whether one
  /// measurement has 10⁸ times the information of another, or along one axis that along another,
  /// half of all digits. Those of a graph whose measurements are alike keep enough, and no time is
  /// spent on it.
  bool is_wide() const;

 private:
  struct Bounds {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;

    void add(double value);
    bool is_wide() const;
  };

  Bounds position_;
  Bounds heading_;
  double own_ = 1.0;
};

}  // namespace fathom
