#include "estimators/sparse_gauss_newton/drift.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

// Of a step that was not measured, m² and rad²: beyond any residual.
constexpr double kHoleVariance = 1e12;

const Node& node_of(std::span<const Node> nodes, int k) {
  return nodes[static_cast<std::size_t>(k)];
}

// (u, φ) at p ↔ the twist about the origin: sign −1 there, +1 back.
Eigen::Matrix3d carry(const Node& at, double sign) {
  Eigen::Matrix3d L = Eigen::Matrix3d::Identity();
  L(0, 2) = sign * -at.y;
  L(1, 2) = sign * at.x;
  return L;
}

Eigen::Matrix3d turn(double c, double s) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() << c, -s, s, c;
  return R;
}

}  // namespace

Drift::Drift(std::span<const Edge> edges, std::span<const char> is_loop,
             std::span<const Node> nodes)
    : sums_(nodes.size(), Eigen::Matrix3d::Zero()) {
  std::vector<char> has_step(nodes.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (is_loop[e] != 0) continue;
    const Edge& step = edges[e];
    const auto newest = static_cast<std::size_t>(std::max(step.from, step.to));
    const Node& from = node_of(nodes, step.from);
    const Eigen::Matrix3d world = transport(turn(from.c, from.s), covariance_of(step));
    sums_[newest] = transport(carry(node_of(nodes, step.to), -1.0), world);
    has_step[newest] = 1;
  }
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    if (has_step[k] == 0) sums_[k] = kHoleVariance * Eigen::Matrix3d::Identity();
    sums_[k] = sums_[k - 1] + sums_[k];
  }
}

Eigen::Matrix3d Drift::of(const Edge& edge, std::span<const Node> nodes) const {
  const auto [first, last] = std::minmax(edge.from, edge.to);
  const Eigen::Matrix3d twist =
      sums_[static_cast<std::size_t>(last)] - sums_[static_cast<std::size_t>(first)];
  const Node& from = node_of(nodes, edge.from);
  const Eigen::Matrix3d at_end = transport(carry(node_of(nodes, edge.to), 1.0), twist);
  return transport(turn(from.c, -from.s), at_end);
}

double least_chi2(const Drift& drift, const Edge& edge, int rank, std::span<const Node> nodes) {
  const Node& i = node_of(nodes, edge.from);
  const Node& k = node_of(nodes, edge.to);
  Eigen::Vector3d nu = residual_of(edge, i, k);
  Eigen::LLT<Eigen::Matrix3d> S;
  if (rank == 3) {
    S.compute(covariance_of(edge) + drift.of(edge, nodes));
  } else {
    const InformationRows measured = rows_of(full(edge.W));
    nu = measured.rows * nu;
    S.compute(transport(measured.rows, drift.of(edge, nodes)) +
              Eigen::Matrix3d(measured.variances.asDiagonal()));
  }
  return S.info() == Eigen::Success ? nu.dot(S.solve(nu)) : 0.0;
}

}  // namespace fathom::sparse_gauss_newton
