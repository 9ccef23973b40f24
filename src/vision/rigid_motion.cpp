#include "rigid_motion.hpp"

#include <cmath>
#include <cstddef>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

void require_pairs(std::size_t p_count, std::size_t q_count) {
  if (p_count != q_count) {
    throw InputError(fmt::format("points must come in pairs, got {} and {}", p_count, q_count));
  }
}

Eigen::Vector2d mean_of(std::span<const Eigen::Vector2d> points, std::span<const double> weights) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double total = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    sum += weights[j] * points[j];
    total += weights[j];
  }
  return sum / total;
}

}  // namespace

std::optional<Pose> find_motion(std::span<const Eigen::Vector2d> p,
                                std::span<const Eigen::Vector2d> q) {
  return find_motion(p, q, std::vector<double>(p.size(), 1.0));
}

std::optional<Pose> find_motion(std::span<const Eigen::Vector2d> p,
                                std::span<const Eigen::Vector2d> q,
                                std::span<const double> weights) {
  require_pairs(p.size(), q.size());
  require_pairs(p.size(), weights.size());
  if (p.size() < 2) return std::nullopt;
  const Eigen::Vector2d p_mean = mean_of(p, weights);
  const Eigen::Vector2d q_mean = mean_of(q, weights);
  // Σ q'·p' and Σ q'×p' of the centred points: together the direction of the best heading.
  double cosine = 0.0;
  double sine = 0.0;
  double p_square = 0.0;
  double q_square = 0.0;
  for (std::size_t j = 0; j < p.size(); ++j) {
    const Eigen::Vector2d dp = p[j] - p_mean;
    const Eigen::Vector2d dq = q[j] - q_mean;
    cosine += weights[j] * (dq.x() * dp.x() + dq.y() * dp.y());
    sine += weights[j] * (dq.x() * dp.y() - dq.y() * dp.x());
    p_square += weights[j] * p[j].squaredNorm();
    q_square += weights[j] * q[j].squaredNorm();
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

}  // namespace fathom
