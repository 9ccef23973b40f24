#pragma once

#include <optional>

#include <Eigen/Core>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::pose_graph {

/// What an error of a step, in the axes of the keyframe it begins at, does to the end of its chain:
/// A = [R  (−dy, dx)ᵀ; 0 1], R the turn of the step's begin, (dx, dy) from the step's end to the
/// chain's.
struct StepLever {
  double c = 1.0;
  double s = 0.0;
  double dx = 0.0;
  double dy = 0.0;

  Eigen::Vector3d along(const Eigen::Vector3d& error) const {
    return {c * error.x() - s * error.y() - dy * error.z(),
            s * error.x() + c * error.y() + dx * error.z(), error.z()};
  }
  /// Aᵀ λ.
  Eigen::Vector3d back(const Eigen::Vector3d& force) const {
    return {c * force.x() + s * force.y(), -s * force.x() + c * force.y(),
            -dy * force.x() + dx * force.y() + force.z()};
  }
  /// A C Aᵀ.
  Eigen::Matrix3d moved(const Eigen::Matrix3d& C) const {
    Eigen::Matrix3d half;
    for (int i = 0; i < 3; ++i) half.col(i) = along(C.col(i));
    Eigen::Matrix3d whole;
    for (int i = 0; i < 3; ++i) whole.col(i) = along(half.row(i).transpose());
    return whole;
  }
};

/// Where a step leads whose measurement is corrected by `error`.
inline Eigen::Vector2d place_behind(const Node& from, const Edge& z, const Eigen::Vector3d& error) {
  const double x = z.x + error.x();
  const double y = z.y + error.y();
  return {from.x + from.c * x - from.s * y, from.y + from.s * x + from.c * y};
}
inline Node behind(const Node& from, const Edge& z,
                   const Eigen::Vector3d& error = Eigen::Vector3d::Zero()) {
  const Eigen::Vector2d place = place_behind(from, z, error);
  return make_node(place.x(), place.y(), from.theta + z.theta + error.z());
}

/// Of a step that leads from `begin` to `end`, in a chain that ends at `last`.
inline StepLever lever_of(const Node& begin, const Node& end, const Node& last) {
  return {begin.c, begin.s, last.x - end.x, last.y - end.y};
}

/// W⁻¹ by its cofactors; nothing where W is that of fewer than three coordinates, or near it.
inline std::optional<Eigen::Matrix3d> covariance_of_step(const Edge& edge) {
  constexpr double kLeastShare = 1e-9;
  if (edge.shared != nullptr || edge.rows != nullptr) return std::nullopt;
  const auto& [xx, xy, xt, yy, yt, tt] = edge.W;
  const double a = yy * tt - yt * yt;
  const double b = xt * yt - xy * tt;
  const double c = xy * yt - xt * yy;
  const double determinant = xx * a + xy * b + xt * c;
  if (!(determinant > kLeastShare * xx * yy * tt)) return std::nullopt;
  Eigen::Matrix3d C;
  C << a, b, c, b, xx * tt - xt * xt, xy * xt - xx * yt, c, xy * xt - xx * yt, xx * yy - xy * xy;
  return C / determinant;
}

}  // namespace fathom::pose_graph
