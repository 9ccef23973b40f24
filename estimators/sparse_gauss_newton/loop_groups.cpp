#include "estimators/sparse_gauss_newton/loop_groups.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>

#include <Eigen/Core>
#include <Eigen/LU>

#include "fathom/core/disjoint_sets.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

Eigen::Matrix3d lever(double dx, double dy) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 2) = -dy;
  T(1, 2) = dx;
  return T;
}

}  // namespace

bool is_forward(const Edge& edge) {
  return edge.to > edge.from;
}

std::vector<std::vector<std::size_t>> group_loops(
    std::span<const Edge> edges, std::vector<std::size_t> loops, int reach,
    const std::function<bool(const Edge&, const Edge&)>& belong) {
  // By the earlier and the later end: a loop may be written in either direction.
  const auto ends = [&](std::size_t e) { return std::minmax(edges[e].from, edges[e].to); };
  std::stable_sort(loops.begin(), loops.end(),
                   [&](std::size_t a, std::size_t b) { return ends(a).first < ends(b).first; });
  DisjointSets sets(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::pair<int, int> a = ends(loops[i]);
    for (std::size_t j = i + 1; j < loops.size(); ++j) {
      const std::pair<int, int> b = ends(loops[j]);
      if (b.first - a.first > reach) break;
      if (std::abs(b.second - a.second) > reach || sets.root(i) == sets.root(j)) continue;
      if (belong(edges[loops[i]], edges[loops[j]])) sets.join(i, j);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < loops.size(); ++i) by_root[sets.root(i)].push_back(loops[i]);
  std::vector<std::vector<std::size_t>> groups;
  groups.reserve(by_root.size());
  for (auto& [root, group] : by_root) groups.push_back(std::move(group));
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

double group_chi2(NormalEquations& equations, const std::vector<std::size_t>& group,
                  std::span<const double> weights, std::span<const Node> nodes) {
  const sparse::Symbolic& symbolic = equations.factor().symbolic();
  Eigen::Vector3d g = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::MatrixX3d B = Eigen::MatrixX3d::Zero(3 * Eigen::Index{symbolic.size()}, 3);
  const auto add = [&](int keyframe, const Eigen::Matrix3d& block) {
    if (keyframe == 0) return;
    B.middleRows<3>(3 * Eigen::Index{symbolic.position[at(keyframe - 1)]}) += block;
  };
  const Edge& first = equations.edges()[group.front()];
  const Node& centre = nodes[at(first.to)];
  for (const std::size_t e : group) {
    const Edge& edge = equations.edges()[e];
    // Of a loop written the other way round the same motion is the opposite one of its `to`.
    const double sign = is_forward(edge) == is_forward(first) ? 1.0 : -1.0;
    const Node& k = nodes[at(edge.to)];
    EdgeTerms t = linearise_edge(edge, nodes[at(edge.from)], k);
    scale(weights[e], t);
    const Eigen::Matrix3d M = full(t.M);
    const Eigen::Matrix3d T_k = sign * lever(k.x - centre.x, k.y - centre.y);
    g += T_k.transpose() * Eigen::Vector3d(t.m[0], t.m[1], t.m[2]);
    information += T_k.transpose() * M * T_k;
    add(edge.to, M * T_k);
    add(edge.from, -lever(t.dx, t.dy).transpose() * M * T_k);
  }
  Eigen::MatrixX3d solved = B;
  for (int column = 0; column < 3; ++column) equations.solve(solved.col(column).data());
  const Eigen::Matrix3d left = information - B.transpose() * solved;
  const double chi2 = g.dot(left.inverse() * g);
  // Nothing else checks the group.
  return std::isfinite(chi2) && chi2 > 0.0 ? chi2 : 0.0;
}

}  // namespace fathom::sparse_gauss_newton
