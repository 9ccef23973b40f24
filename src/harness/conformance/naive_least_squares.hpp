#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

/// A textbook least-squares solver, dense and slow, to compare with. It shares with the estimators
/// only ⊖ and its Jacobians, which are tested against differences.
namespace fathom::conformance {

/// Dense Gauss-Newton over the poses of F = Σ eᵀ Ω e, all but keyframe 0 unless that is uncertain,
/// and the covariance (Σ Jᵀ Ω J)⁻¹.
struct NaiveLeastSquares {
  std::vector<Pose> poses;
  Eigen::MatrixXd covariance;
  std::size_t first = 1;  ///< keyframe of its first row

  Eigen::Matrix3d marginal(std::size_t k) const;
  Eigen::MatrixXd joint(const std::vector<std::size_t>& keyframes) const;
  /// ⊖X_k ⊕ X_n to the newest keyframe n.
  UncertainPose motion_to_newest(std::size_t k) const;
};

/// The largest difference of two joint covariances' 3×3 blocks (a, b), as a share of
/// √(‖C_aa‖ ‖C_bb‖); the difference itself where a keyframe has none.
double largest_block_difference(const Eigen::MatrixXd& joint, const Eigen::MatrixXd& expected);

/// `poses`: where to begin; none: dead reckoning. Errors that are shared are by the joint
/// covariance of all registrations.
NaiveLeastSquares least_squares(const MeasurementLog& log, int iterations,
                                std::vector<Pose> poses = {},
                                RegistrationErrors errors = RegistrationErrors::independent);

}  // namespace fathom::conformance
