#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/sparse_gauss_newton/loop_graph.hpp"

namespace fathom::sparse_gauss_newton {

/// How far dead reckoning alone drifts between any two keyframes: the covariance of ν of an edge
/// without any loop, which is the most that an estimate can have.
///
/// An error (u, φ) of a step that ends at p moves all that follows by the twist (u − φ J p, φ)
/// about the origin, J a quarter turn; twists of steps are independent and add up, so the drift of
/// a stretch is a difference of two sums over the trajectory.
class Drift {
 public:
  /// Steps are the edges that are no loops, one a keyframe, in order.
  Drift(std::span<const Edge> edges, std::span<const char> is_loop, std::span<const Node> nodes);

  /// 3×3, axes of `from`, at these nodes.
  Eigen::Matrix3d of(const Edge& edge, std::span<const Node> nodes) const;

 private:
  std::vector<Eigen::Matrix3d> sums_;  ///< of twist covariances up to each keyframe
};

/// νᵀ (R + drift)⁻¹ ν: no estimate, whatever loops it uses, would have less against this loop.
double least_chi2(const Drift& drift, const Edge& edge, int rank, std::span<const Node> nodes);

}  // namespace fathom::sparse_gauss_newton
