#include "fathom/vision/rigid_motion.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

void require_pairs(std::size_t p_count, std::size_t q_count) {
  if (p_count != q_count) {
    throw InputError("points must come in pairs, got " + std::to_string(p_count) + " and " +
                     std::to_string(q_count));
  }
}

Eigen::Vector2d mean_of(std::span<const Eigen::Vector2d> points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

std::optional<Pose> find_motion(std::span<const Eigen::Vector2d> p,
                                std::span<const Eigen::Vector2d> q) {
  require_pairs(p.size(), q.size());
  if (p.size() < 2) return std::nullopt;
  const Eigen::Vector2d p_mean = mean_of(p);
  const Eigen::Vector2d q_mean = mean_of(q);
  // Σ q'·p' and Σ q'×p' of the centred points: together the direction of the best heading.
  double cosine = 0.0;
  double sine = 0.0;
  double p_square = 0.0;
  double q_square = 0.0;
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Eigen::Vector2d dp = p[j] - p_mean;
    const Eigen::Vector2d dq = q[j] - q_mean;
    cosine += dq.x() * dp.x() + dq.y() * dp.y();
    sine += dq.x() * dp.y() - dq.y() * dp.x();
    p_square += p[j].squaredNorm();
    q_square += q[j].squaredNorm();
  }
  // Centring leaves rounding of the size of the points; below it there is no direction. Written so
  // that NaN fails too.
  constexpr double kRounding = 1e-13;
  if (!(std::hypot(cosine, sine) > kRounding * std::sqrt(p_square * q_square))) return std::nullopt;
  const double theta = std::atan2(sine, cosine);
  const Eigen::Vector2d t = p_mean - rotation(theta) * q_mean;
  const Pose z{t.x(), t.y(), wrap_angle(theta)};
  return is_finite(z) ? std::optional(z) : std::nullopt;
}

double squared_error(const Pose& z, std::span<const Eigen::Vector2d> p,
                     std::span<const Eigen::Vector2d> q) {
  require_pairs(p.size(), q.size());
  const Eigen::Matrix2d R = rotation(z.theta);
  double sum = 0.0;
  for (std::size_t j = 0; j < p.size(); ++j) {
    sum += (p[j] - z.position() - R * q[j]).squaredNorm();
  }
  return sum;
}

Eigen::Matrix3d motion_covariance(const Pose& z, std::span<const Eigen::Vector2d> p,
                                  std::span<const Eigen::Vector2d> q) {
  const double n = static_cast<double>(p.size());
  const double variance = squared_error(z, p, q) / (2.0 * n - 3.0);
  // About the centroid the translation and the heading are independent: var(θ) = σ² / Σ ‖q'‖², and
  // the centroid's σ²/n moves to the origin of `to` along a = dt/dθ = −Rot(θ + 90°) q̄. This is
  // (JᵀJ)⁻¹ written out, without the cancellation of a matrix inverse.
  const Eigen::Vector2d q_mean = mean_of(q);
  double spread = 0.0;
  for (const Eigen::Vector2d& point : q) spread += (point - q_mean).squaredNorm();
  const Eigen::Vector2d turned = rotation(z.theta) * q_mean;
  const Eigen::Vector3d lever(turned.y(), -turned.x(), 1.0);
  Eigen::Matrix3d covariance = lever * lever.transpose() / spread;
  covariance(0, 0) += 1.0 / n;
  covariance(1, 1) += 1.0 / n;
  return variance * covariance;
}

}  // namespace fathom
