#include "estimators/support/pose_graph/edge.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/precision.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::pose_graph {

Edge make_edge(const RelativePose& measurement) {
  const Eigen::Matrix3d D = planar_rotation(measurement.motion.theta);
  const Eigen::Matrix3d W = D * measurement.information * D.transpose();
  Edge edge;
  edge.from = static_cast<int>(measurement.from);
  edge.to = static_cast<int>(measurement.to);
  edge.x = measurement.motion.x;
  edge.y = measurement.motion.y;
  edge.theta = measurement.motion.theta;
  edge.W = {W(0, 0), 0.5 * (W(0, 1) + W(1, 0)), 0.5 * (W(0, 2) + W(2, 0)),
            W(1, 1), 0.5 * (W(1, 2) + W(2, 1)), W(2, 2)};
  return edge;
}

Edge WideRows::make_edge(const RelativePose& measurement) {
  constexpr double kTwoDigitsLeft = 1e14;
  Edge edge = pose_graph::make_edge(measurement);
  if (!(own_spread(measurement.information) > kTwoDigitsLeft)) return edge;
  const Eigen::Matrix3d D = planar_rotation(measurement.motion.theta);
  edge.rows = &rows_.emplace_back(whitening(measurement.information) * D.transpose());
  return edge;
}

void weigh(double weight, Edge& edge) {
  if (weight == 1.0) return;
  for (double& element : edge.W) element *= weight;
  edge.rows = nullptr;
}

Eigen::Matrix3d full(const std::array<double, 6>& upper) {
  Eigen::Matrix3d matrix;
  matrix << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4],
      upper[5];
  return matrix;
}

Eigen::Matrix3d covariance_of(const Edge& edge) {
  return symmetric_inverse(full(edge.W));
}

Pose pose_of(const Node& node) {
  return {node.x, node.y, wrap_angle(node.theta)};
}

Eigen::Vector3d residual_of(const Edge& edge, const Node& i, const Node& k) {
  const double dx = k.x - i.x;
  const double dy = k.y - i.y;
  return {i.c * dx + i.s * dy - edge.x, -i.s * dx + i.c * dy - edge.y,
          wrap_angle(k.theta - i.theta - edge.theta)};
}

double heading_information(const Edge& edge) {
  const auto& W = edge.W;
  const double determinant = W[0] * W[3] - W[1] * W[1];
  // Of a position that is measured in one direction at most: what that direction does not explain.
  if (!(determinant > kLeastPivotShare * W[0] * W[3])) {
    const double trace = W[0] + W[3];
    const double along = W[2] * W[2] + W[4] * W[4];
    return trace > 0.0 ? std::max(W[5] - along / trace, 0.0) : W[5];
  }
  const double lost =
      (W[3] * W[2] * W[2] - 2.0 * W[1] * W[2] * W[4] + W[0] * W[4] * W[4]) / determinant;
  return W[5] - lost;
}

bool measures_heading(const Edge& edge) {
  return heading_information(edge) > kLeastHeadingShare * edge.W[5];
}

std::vector<Node> nodes_of(std::span<const Pose> poses) {
  std::vector<Node> nodes;
  nodes.reserve(poses.size());
  for (const Pose& pose : poses) nodes.push_back(make_node(pose.x, pose.y, pose.theta));
  return nodes;
}

std::size_t keyframes_of(std::span<const Node> nodes) {
  if (nodes.empty() || is_pose(nodes.back())) return nodes.size();
  return static_cast<std::size_t>(std::ranges::partition_point(nodes, is_pose) - nodes.begin());
}

Edge without_errors(const Edge& edge, std::span<const Node> nodes) {
  Edge left = edge;
  for (const SharedEnds::End* end : {&edge.shared->from, &edge.shared->to}) {
    if (end->node < 0) continue;
    const Node& n = nodes[at(end->node)];
    const Eigen::Vector3d error = end->G * Eigen::Vector3d(n.x, n.y, n.theta);
    left.x -= error.x();
    left.y -= error.y();
    left.theta -= error.z();
  }
  return left;
}

double cost_of(std::span<const Edge> edges, std::span<const Node> nodes) {
  double sum = 0.0;
  for (const Edge& edge : edges) sum += linearise_edge(edge, nodes).cost;
  for (const Node& n : nodes.subspan(keyframes_of(nodes))) {
    sum += n.x * n.x + n.y * n.y + n.theta * n.theta;
  }
  return sum;
}

}  // namespace fathom::pose_graph
