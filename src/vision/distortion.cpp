#include "distortion.hpp"

#include <Eigen/LU>

namespace fathom {
namespace {

constexpr double kTolerance = 1e-12;

// Newton's method on distort(x) = target. A step that would cross the fold (Jacobian not positive)
// or lose ground is halved, which keeps to the branch that `x` starts on. False without a solution.
bool solve(const Distortion& distortion, const Eigen::Vector2d& target, Eigen::Vector2d& x) {
  constexpr int kSteps = 50;
  constexpr double kShortestStep = 1e-6;
  Eigen::Matrix2d J;
  Eigen::Vector2d error = target - distort(distortion, x, &J);
  for (int step = 0; step < kSteps; ++step) {
    if (error.norm() <= 0.01 * kTolerance) return true;
    const Eigen::Vector2d newton = J.inverse() * error;
    double length = 1.0;
    Eigen::Vector2d next;
    Eigen::Vector2d next_error;
    for (;; length *= 0.5) {
      if (length < kShortestStep) return error.norm() <= kTolerance;
      next = x + length * newton;
      next_error = target - distort(distortion, next, &J);
      if (J.determinant() > 0.0 && J.trace() > 0.0 && next_error.norm() < error.norm()) break;
    }
    x = next;
    error = next_error;
  }
  return error.norm() <= kTolerance;
}

}  // namespace

Eigen::Vector2d distort(const Distortion& distortion, const Eigen::Vector2d& ideal,
                        Eigen::Matrix2d* distorted_ideal) {
  const auto [k1, k2, p1, p2, k3] = distortion;
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  if (distorted_ideal != nullptr) {
    const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / (x dx)
    const double cross = x * y * slope + 2.0 * (p1 * x + p2 * y);
    *distorted_ideal << radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, cross, cross,
        radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

std::optional<Eigen::Vector2d> undistort(const Distortion& distortion,
                                         const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  Eigen::Vector2d ideal = Eigen::Vector2d::Zero();
  if (!solve(distortion, distorted, ideal)) return std::nullopt;
  return ideal;
}

}  // namespace fathom
