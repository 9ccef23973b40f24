#include "map_frame.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Eigenvalues>

namespace fathom {

bool is_drawable(const Pose& pose) {
  constexpr double kFarthest = 1e9;
  return is_finite(pose) && std::abs(pose.x) <= kFarthest && std::abs(pose.y) <= kFarthest;
}

std::optional<Eigen::Matrix2d> two_sigma_axes(const Eigen::Matrix2d& P) {
  if (!P.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(P);
  if (solver.info() != Eigen::Success || !(solver.eigenvalues().minCoeff() > 0.0)) {
    return std::nullopt;
  }
  const Eigen::Vector2d lengths = 2.0 * solver.eigenvalues().cwiseSqrt();
  return solver.eigenvectors() * lengths.asDiagonal();
}

std::vector<Eigen::Vector2d> two_sigma_ellipse(const Eigen::Matrix3d& covariance) {
  const auto axes = two_sigma_axes(covariance.topLeftCorner<2, 2>());
  std::vector<Eigen::Vector2d> polygon;
  if (!axes) return polygon;
  constexpr int kCorners = 72;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    polygon.push_back(*axes * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return polygon;
}

ChartFrame map_frame(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Box& outer) {
  const Eigen::Vector2d centre = 0.5 * (low + high);
  Eigen::Vector2d extent = high - low;
  // All at one place: a metre round it, or what its coordinates still tell apart.
  const double least = 1e-9 * std::max(1.0, centre.cwiseAbs().maxCoeff());
  if (extent.maxCoeff() < least) extent.setConstant(std::max(1.0, least));
  extent = extent.cwiseMax(least);
  constexpr double kMargin = 1.1;
  const auto frame_in = [&](const Box& axes) {
    const double metres_per_point =
        kMargin * std::max(extent.x() / axes.height, extent.y() / axes.width);
    const Eigen::Vector2d half = 0.5 * metres_per_point * Eigen::Vector2d(axes.height, axes.width);
    ChartAxis across = axis_between({"y", "m"}, centre.y() - half.y(), centre.y() + half.y());
    std::swap(across.low, across.high);
    across.grid = true;
    return ChartFrame(std::move(across),
                      axis_between({"x", "m"}, centre.x() - half.x(), centre.x() + half.x()),
                      outer);
  };
  // The labels decide the box of the axes, which decides the labels: it shrinks until they fit.
  Box box = frame_in(outer).box();
  for (int i = 0; i < 3; ++i) box = intersection(box, frame_in(box).box());
  return frame_in(box).with_box(box);
}

}  // namespace fathom
