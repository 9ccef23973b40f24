// The Gauss-Newton step of NormalEquations without the sums of its matrix.

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "estimators/support/sparse/row_elimination.hpp"
#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/precision.hpp"

namespace fathom::pose_graph {
namespace {

using sparse::LeastSquaresRows;

Eigen::Matrix3d whitening_of(const Edge& edge) {
  return edge.rows != nullptr ? *edge.rows : whitening(full(edge.W));
}

Eigen::Vector3d whitened_residual(const Eigen::Matrix3d& U, const Edge& edge,
                                  std::span<const Node> nodes) {
  const Edge left = edge.shared == nullptr ? edge : without_errors(edge, nodes);
  return U * residual_of(left, nodes[at(edge.from)], nodes[at(edge.to)]);
}

// Of ν + J δ: with W = Uᵀ U the rows are U J, and the right side −U ν.
LeastSquaresRows whitened_rows(const Edge& edge, std::span<const Node> nodes,
                               const sparse::Symbolic& symbolic) {
  const Node& i = nodes[at(edge.from)];
  const Node& k = nodes[at(edge.to)];
  const Eigen::Matrix3d U = whitening_of(edge);
  Eigen::Matrix3d P = Eigen::Matrix3d::Identity();
  P.topLeftCorner<2, 2>() << i.c, i.s, -i.s, i.c;
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T.topRightCorner<2, 1>() << -(k.y - i.y), k.x - i.x;
  LeastSquaresRows rows;
  const auto add = [&](int node, const Eigen::Matrix3d& J) {
    if (node > 0) rows.blocks.push_back({position_of(symbolic, node), U * J});
  };
  add(edge.from, -P * T);
  add(edge.to, P);
  rows.right = -whitened_residual(U, edge, nodes);
  if (edge.shared == nullptr) return rows;
  for (const SharedEnds::End* end : {&edge.shared->from, &edge.shared->to}) add(end->node, end->G);
  return rows;
}

}  // namespace

std::optional<double> NormalEquations::solve_rows(std::span<const Node> nodes) {
  const sparse::Symbolic& symbolic = factor_.symbolic();
  std::vector<LeastSquaresRows> rows;
  rows.reserve(edges_.size());
  for (const Edge& edge : edges_) rows.push_back(whitened_rows(edge, nodes, symbolic));
  for (std::size_t n = keyframes_of(nodes); n < nodes.size(); ++n) {
    const Eigen::Vector3d errors(nodes[n].x, nodes[n].y, nodes[n].theta);
    rows.push_back(
        {{{position_of(symbolic, static_cast<int>(n)), Eigen::Matrix3d::Identity()}}, -errors});
  }
  if (!sparse::eliminate_rows(rows, kLeastPivotShare, factor_, step_.data())) return std::nullopt;
  double promised = 0.0;
  for (const double y : step_) promised += y * y;
  factor_.solve_transposed(step_.data());
  return promised;
}

void NormalEquations::halve_step() {
  for (double& d : step_) d *= 0.5;
}

double whitened_cost(std::span<const Edge> edges, std::span<const Node> nodes) {
  double sum = 0.0;
  for (const Edge& edge : edges) {
    sum += whitened_residual(whitening_of(edge), edge, nodes).squaredNorm();
  }
  for (const Node& n : nodes.subspan(keyframes_of(nodes))) {
    sum += n.x * n.x + n.y * n.y + n.theta * n.theta;
  }
  return sum;
}

}  // namespace fathom::pose_graph
