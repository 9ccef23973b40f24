#pragma once

#include "estimators/incremental_smoother/local_edge.hpp"

namespace fathom::incremental_smoother {

/// A rigid motion of the plane, given by where it takes one keyframe.
class RigidMotion {
 public:
  RigidMotion(const Node& from, const Node& to)
      : from_(from),
        to_(to),
        turn_(to.theta - from.theta),
        c_(to.c * from.c + to.s * from.s),
        s_(to.s * from.c - to.c * from.s) {}

  /// This one after an earlier one.
  RigidMotion after(const RigidMotion& earlier) const {
    return RigidMotion(earlier.from_, (*this)(earlier.to_));
  }

  Node operator()(const Node& v) const {
    const double dx = v.x - from_.x;
    const double dy = v.y - from_.y;
    return {to_.x + c_ * dx - s_ * dy, to_.y + s_ * dx + c_ * dy, v.theta + turn_,
            c_ * v.c - s_ * v.s, s_ * v.c + c_ * v.s};
  }

 private:
  Node from_;
  Node to_;
  double turn_;
  double c_;
  double s_;
};

/// How far `to` lies from `from`, along the axes of `from`.
inline void offset_of(const Node& from, const Node& to, double* d) {
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  d[0] = from.c * dx + from.s * dy;
  d[1] = -from.s * dx + from.c * dy;
  d[2] = to.theta - from.theta;
}

/// A keyframe corrected along its own axes.
inline Node corrected(const Node& v, const double* d) {
  return make_node(v.x + v.c * d[0] - v.s * d[1], v.y + v.s * d[0] + v.c * d[1], v.theta + d[2]);
}

/// The same of a picture's errors, which have no axes.
inline void errors_between(const Node& from, const Node& to, double* d) {
  d[0] = to.x - from.x;
  d[1] = to.y - from.y;
  d[2] = to.theta - from.theta;
}
inline Node corrected_errors(const Node& n, const double* d) {
  return pose_graph::make_errors(n.x + d[0], n.y + d[1], n.theta + d[2]);
}

}  // namespace fathom::incremental_smoother
