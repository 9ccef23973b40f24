#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

/// The covariance of what the keypoints of a picture have in common by how it was blurred and lit,
/// which does not average out however many there are: a `share` of the error of one match, `rms_m`.
/// In x and y alone.
Eigen::Matrix3d shared_error(double rms_m, double share);

/// A weighted fit of z to points p = z ⊕ q, linearised: what errors of the points do to z.
/// r_j = p_j − z ⊕ q_j, J_j = ∂(z ⊕ q_j)/∂z, A = Σ w JᵀJ; all covariances in axes of `from`.
class LinearFit {
 public:
  /// All four of one length, which is at least 2. Keeps the spans.
  LinearFit(const Pose& z, std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q,
            std::span<const double> weights);

  /// Fits z again together with the errors of altitude and tilt that are told (σ > 0), which are
  /// not the registration's own, as unknowns without a prior. From here on r is what is left, and 3
  /// is the number of unknowns that the matches can tell, up to 8. z stays. Returns the ratio of σ
  /// to the one before.
  double take_out_altitude_and_tilt(const Viewpoint& from, const Viewpoint& to,
                                    const CovarianceOptions& options);

  /// σ² A⁻¹ with σ² = Σ w ‖r‖² / (2n − 3), errors taken for independent.
  Eigen::Matrix3d covariance() const;

  /// How much more it is where errors within a square of `cell_m` are alike: the mean ratio of
  /// A⁻¹ (Σ_c g_c g_cᵀ) A⁻¹, g_c = Σ_{j ∈ c} w Jᵀ r, to covariance(). At least 1; 1 with fewer
  /// than `least_cells` squares.
  double clustering(double cell_m, int least_cells) const;

  /// Of errors that the points of one picture share: of its altitude, by the larger of what its
  /// sensor and the options state, and of its roll and pitch, as measured, else as of the options;
  /// those of two pictures are independent. `own` is left at zero.
  ///
  /// n is assumed less true: a point is taken to lie D n from where it does, D its derivative by
  /// altitude, roll and pitch. In `from` that moves p, and z by the response; in `to` it moves q,
  /// and z by the opposite.
  SharedErrors altitude_and_tilt(const Viewpoint& from, const Viewpoint& to,
                                 const CovarianceOptions& options) const;

 private:
  Eigen::Matrix<double, 2, 3> jacobian(std::size_t j) const;
  double variance() const;  // σ²
  /// √w times J, then times what a shift by each error that is told does to the points.
  Eigen::MatrixXd whitened_columns(const Viewpoint& from, const Viewpoint& to,
                                   const CovarianceOptions& options) const;
  /// What a shift of every point by shift(j), p minus z ⊕ q, does to z.
  template <class Shift>
  Eigen::Vector3d response(const Shift& shift) const;

  Pose z_;
  std::span<const Eigen::Vector2d> p_;
  std::span<const Eigen::Vector2d> q_;
  std::span<const double> weights_;
  Eigen::Matrix3d inverse_;  // A⁻¹
  std::vector<Eigen::Vector2d> residuals_;
  double unknowns_ = 3.0;
};

/// Of the parts of two pictures together, without what is the registration's own.
Eigen::Matrix3d total_of(const PictureErrors& from, const PictureErrors& to);

}  // namespace fathom
