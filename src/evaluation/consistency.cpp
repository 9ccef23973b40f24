#include "fathom/evaluation/consistency.hpp"

#include <cmath>
#include <numeric>
#include <string>

#include <Eigen/Cholesky>

#include "checks.hpp"
#include "fathom/core/chi_squared.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// The covariance in world axes that the alignment turned by theta.
Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, double theta_rad) {
  return transport(planar_rotation(theta_rad), covariance);
}

Eigen::Vector3d pose_error(const Pose& estimate, const Pose& reference) {
  return {estimate.x - reference.x, estimate.y - reference.y,
          wrap_angle(estimate.theta - reference.theta)};
}

}  // namespace

std::optional<Consistency> consistency(std::span<const Pose> estimate,
                                       std::span<const Pose> reference,
                                       std::span<const Eigen::Matrix3d> covariances,
                                       Alignment alignment) {
  require_same_length(estimate.size(), covariances.size(), "covariances");
  const Aligned aligned = align(estimate, reference, alignment);
  if (estimate.size() < 2 || !all_finite(estimate) || !all_finite(reference)) return std::nullopt;
  Consistency result;
  std::size_t inside = 0;
  for (std::size_t k = 1; k < estimate.size(); ++k) {
    if (!is_positive_definite(covariances[k])) return std::nullopt;
    const Eigen::Matrix3d P = turned(covariances[k], aligned.motion_reference_estimate.theta);
    const Eigen::Vector3d e = pose_error(aligned.poses[k], reference[k]);
    result.pose_nees.push_back(e.dot(symmetric_inverse(P) * e));
    const Eigen::Vector2d position = e.head<2>();
    const Eigen::Matrix2d P_position = P.topLeftCorner<2, 2>();
    result.position_nees.push_back(position.dot(P_position.llt().solve(position)));
    constexpr double kTwoSigmaSquared = 4.0;
    if (result.position_nees.back() <= kTwoSigmaSquared) ++inside;
  }
  result.anees = mean(result.pose_nees) / 3.0;
  result.position_anees = mean(result.position_nees) / 2.0;
  result.share_inside_2_sigma =
      static_cast<double>(inside) / static_cast<double>(result.position_nees.size());
  if (!std::isfinite(result.anees) || !std::isfinite(result.position_anees)) return std::nullopt;
  return result;
}

Interval anees_interval(std::size_t trials, std::size_t degrees_of_freedom, double probability) {
  if (trials == 0 || degrees_of_freedom == 0) {
    throw InputError("an ANEES interval needs at least 1 trial and 1 degree of freedom");
  }
  if (!(probability > 0.0 && probability < 1.0)) {
    throw InputError("an ANEES interval needs a probability between 0 and 1, got " +
                     std::to_string(probability));
  }
  const double dof = static_cast<double>(trials) * static_cast<double>(degrees_of_freedom);
  const double tail = 0.5 * (1.0 - probability);
  return {chi_squared_quantile(tail, dof) / dof, chi_squared_quantile(1.0 - tail, dof) / dof};
}

}  // namespace fathom
