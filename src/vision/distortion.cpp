#include "distortion.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

namespace fathom {
namespace {

using Coefficients = std::array<double, 8>;

constexpr double kTolerance = 1e-12;
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

// Newton's method on distort(x) = target. A step that would cross the fold (Jacobian not positive)
// or lose ground is halved, which keeps to the branch that `x` starts on. False without a solution.
template <class Distort>
bool solve(const Distort& distorted_at, const Eigen::Vector2d& target, Eigen::Vector2d& x) {
  constexpr int kSteps = 50;
  constexpr double kShortestStep = 1e-6;
  Eigen::Matrix2d J;
  Eigen::Vector2d error = target - distorted_at(x, &J);
  for (int step = 0; step < kSteps; ++step) {
    if (error.norm() <= 0.01 * kTolerance) return true;
    const Eigen::Vector2d newton = J.inverse() * error;
    double length = 1.0;
    Eigen::Vector2d next;
    Eigen::Vector2d next_error;
    for (;; length *= 0.5) {
      if (length < kShortestStep) return error.norm() <= kTolerance;
      next = x + length * newton;
      next_error = target - distorted_at(next, &J);
      if (J.determinant() > 0.0 && J.trace() > 0.0 && next_error.norm() < error.norm()) break;
    }
    x = next;
    error = next_error;
  }
  return error.norm() <= kTolerance;
}

// Brown's model, and where `has_denominator` that over a second polynomial.
template <bool has_denominator>
Eigen::Vector2d brown(const Coefficients& c, const Eigen::Vector2d& ideal,
                      Eigen::Matrix2d* distorted_ideal) {
  const auto [k1, k2, p1, p2, k3, k4, k5, k6] = c;
  const double x = ideal.x();
  const double y = ideal.y();
  const double r2 = x * x + y * y;
  double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  double denominator = 1.0;
  if constexpr (has_denominator) {
    denominator = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
    if (!(denominator > 0.0)) denominator = std::numeric_limits<double>::quiet_NaN();
    radial /= denominator;
  }
  if (distorted_ideal != nullptr) {
    double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / (x dx)
    if constexpr (has_denominator) {
      slope = (slope - radial * 2.0 * (k4 + r2 * (2.0 * k5 + r2 * 3.0 * k6))) / denominator;
    }
    const double cross = x * y * slope + 2.0 * (p1 * x + p2 * y);
    *distorted_ideal << radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, cross, cross,
        radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  }
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

// How far from the centre an equidistant lens shows a ray at an angle from its axis.
double radius_at(const Coefficients& k, double angle) {
  const double a2 = angle * angle;
  return angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
}

double radius_slope_at(const Coefficients& k, double angle) {
  const double a2 = angle * angle;
  return 1.0 + a2 * (3.0 * k[0] + a2 * (5.0 * k[1] + a2 * (7.0 * k[2] + a2 * 9.0 * k[3])));
}

// So near the axis an angle is its tangent.
constexpr double kOnAxis = 1e-9;

Eigen::Vector2d equidistant(const Coefficients& k, const Eigen::Vector2d& ideal,
                            Eigen::Matrix2d* distorted_ideal) {
  const double r = ideal.norm();
  if (r < kOnAxis) {
    if (distorted_ideal != nullptr) distorted_ideal->setIdentity();
    return ideal;
  }
  const double angle = std::atan(r);
  const double scale = radius_at(k, angle) / r;
  if (distorted_ideal != nullptr) {
    const double along = radius_slope_at(k, angle) / (1.0 + r * r);
    const Eigen::Vector2d outward = ideal / r;
    *distorted_ideal =
        scale * Eigen::Matrix2d::Identity() + (along - scale) * (outward * outward.transpose());
  }
  return scale * ideal;
}

// The radius rises up to the reach: Newton's method, which halves the interval where it leaves it.
std::optional<Eigen::Vector2d> undo_equidistant(const Coefficients& k, double reach_rad,
                                                const Eigen::Vector2d& distorted) {
  constexpr int kSteps = 100;
  constexpr double kRelative = 4.0 * std::numeric_limits<double>::epsilon();
  const double radius = distorted.norm();
  if (radius < kOnAxis) return distorted;
  if (!(radius < radius_at(k, reach_rad))) return std::nullopt;
  double low = 0.0;
  double high = reach_rad;
  double angle = std::min(radius, 0.5 * reach_rad);
  for (int step = 0; step < kSteps; ++step) {
    const double error = radius_at(k, angle) - radius;
    (error > 0.0 ? high : low) = angle;
    double next = angle - error / radius_slope_at(k, angle);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool is_done = std::abs(next - angle) <= kRelative * angle;
    angle = next;
    if (is_done) break;
  }
  return distorted * (std::tan(angle) / radius);
}

}  // namespace

Eigen::Vector2d distort(const CameraModel& lens, const Eigen::Vector2d& ideal,
                        Eigen::Matrix2d* distorted_ideal) {
  switch (lens.distortion_model) {
    case DistortionModel::equidistant:
      return equidistant(lens.distortion, ideal, distorted_ideal);
    case DistortionModel::rational_polynomial:
      return brown<true>(lens.distortion, ideal, distorted_ideal);
    case DistortionModel::radial_tangential:
      break;
  }
  return brown<false>(lens.distortion, ideal, distorted_ideal);
}

std::optional<Eigen::Vector2d> undistort(const CameraModel& lens, double reach_rad,
                                         const Eigen::Vector2d& distorted) {
  if (!distorted.allFinite()) return std::nullopt;
  if (lens.distortion_model == DistortionModel::equidistant) {
    return undo_equidistant(lens.distortion, reach_rad, distorted);
  }
  const bool is_rational = lens.distortion_model == DistortionModel::rational_polynomial;
  const auto shown = [&](const Eigen::Vector2d& ideal, Eigen::Matrix2d* J) {
    return is_rational ? brown<true>(lens.distortion, ideal, J)
                       : brown<false>(lens.distortion, ideal, J);
  };
  Eigen::Vector2d ideal = Eigen::Vector2d::Zero();
  if (!solve(shown, distorted, ideal)) return std::nullopt;
  return ideal;
}

double reach_of(const CameraModel& lens) {
  constexpr int kSteps = 2000;
  if (lens.distortion_model != DistortionModel::equidistant) return kQuarterTurn;
  double rising = 0.0;
  for (int step = 1; step <= kSteps; ++step) {
    double angle = kQuarterTurn * step / kSteps;
    if (radius_slope_at(lens.distortion, angle) > 0.0) {
      rising = angle;
      continue;
    }
    while (angle - rising > kTolerance) {
      const double middle = 0.5 * (rising + angle);
      (radius_slope_at(lens.distortion, middle) > 0.0 ? rising : angle) = middle;
    }
    return rising;
  }
  return kQuarterTurn;
}

bool is_unfolded(const CameraModel& lens, const Eigen::Vector2d& ideal) {
  constexpr int kSteps = 32;
  for (int step = 0; step <= kSteps; ++step) {
    Eigen::Matrix2d J;
    distort(lens, ideal * (step / static_cast<double>(kSteps)), &J);
    if (!(J.determinant() > 0.0 && J.trace() > 0.0)) return false;
  }
  return true;
}

}  // namespace fathom
