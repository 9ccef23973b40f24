#include "estimators/support/pose_graph/normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/estimation/precision.hpp"

namespace fathom::pose_graph {
sparse::Symbolic analyse_graph(std::span<const Edge> edges, int keyframes,
                               sparse::ChainElimination chains, Workers* workers) {
  std::vector<sparse::Link> links;
  links.reserve(edges.size());
  for (const Edge& edge : edges) {
    if (edge.from > 0 && edge.to > 0) links.push_back({edge.from - 1, edge.to - 1});
  }
  return sparse::analyse(sparse::adjacency_of(keyframes - 1, links), chains, workers);
}

NormalEquations::NormalEquations(const sparse::Symbolic& symbolic, std::span<const Edge> edges)
    : edges_(edges),
      factor_(symbolic),
      diagonal_sums_(at(symbolic.size())),
      gradient_(3 * at(symbolic.size())),
      step_(3 * at(symbolic.size())) {
  targets_.reserve(edges.size());
  for (const Edge& edge : edges) {
    Targets t;
    if (edge.from > 0) t.from = symbolic.position[at(edge.from - 1)];
    if (edge.to > 0) t.to = symbolic.position[at(edge.to - 1)];
    if (t.from >= 0 && t.to >= 0) t.cross = factor_.place(edge.from - 1, edge.to - 1);
    targets_.push_back(t);
  }
  diagonal_.reserve(at(symbolic.size()));
  for (const int node : symbolic.node) diagonal_.push_back(factor_.place(node, node));
}

double NormalEquations::linearise(std::span<const Node> nodes, Hessian hessian, double damping) {
  factor_.clear();
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  std::fill(diagonal_sums_.begin(), diagonal_sums_.end(), std::array<double, 6>{});
  double cost = 0.0;
  switch (hessian) {
    case Hessian::gauss_newton:
      cost = add_edges<Hessian::gauss_newton>(nodes);
      break;
    case Hessian::measured:
      cost = add_edges<Hessian::measured>(nodes);
      break;
    case Hessian::exact:
      cost = add_edges<Hessian::exact>(nodes);
      break;
  }
  write_diagonal(damping);
  return cost;
}

template <Hessian kHessian>
double NormalEquations::add_edges(std::span<const Node> nodes) {
  constexpr Lever kLever = kHessian == Hessian::measured ? Lever::measured : Lever::estimated;
  double cost = 0.0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (loss_.leaves_out(e)) continue;
    const Edge& edge = edges_[e];
    EdgeTerms t = linearise_edge(edge, nodes[at(edge.from)], nodes[at(edge.to)], kLever);
    loss_.apply(e, kHessian == Hessian::exact, t);
    cost += t.cost;
    const Targets& target = targets_[e];
    add_gradient(t, target);
    if (target.to >= 0) add_to_end(t, target.to);
    if (target.from >= 0) add_to_begin<kHessian>(t, target);
  }
  return cost;
}

double NormalEquations::differentiate(std::span<const Node> nodes) {
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  double cost = 0.0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (loss_.leaves_out(e)) continue;
    const Edge& edge = edges_[e];
    EdgeTerms t = linearise_edge(edge, nodes[at(edge.from)], nodes[at(edge.to)]);
    loss_.apply(e, false, t);
    cost += t.cost;
    add_gradient(t, targets_[e]);
  }
  return cost;
}

// g_k = m and g_i = −Tᵀ m.
inline void NormalEquations::add_gradient(const EdgeTerms& t, const Targets& target) {
  const auto& m = t.m;
  if (target.to >= 0) {
    double* g = gradient_.data() + 3 * at(target.to);
    for (int a = 0; a < 3; ++a) g[a] += m[at(a)];
  }
  if (target.from >= 0) {
    double* g = gradient_.data() + 3 * at(target.from);
    g[0] -= m[0];
    g[1] -= m[1];
    g[2] -= -t.dy * m[0] + t.dx * m[1] + m[2];
  }
}

// H_kk.
inline void NormalEquations::add_to_end(const EdgeTerms& t, int position) {
  auto& H = diagonal_sums_[at(position)];
  for (std::size_t a = 0; a < 6; ++a) H[a] += t.M[a];
}

// H_ii, and H_ik where k is free.
template <Hessian kHessian>
inline void NormalEquations::add_to_begin(const EdgeTerms& t, const Targets& target) {
  const auto& M = t.M;
  // Row θ of Tᵀ M, and below element (θ, θ) of Tᵀ M T.
  const double rx = -t.dy * M[0] + t.dx * M[1] + M[2];
  const double ry = -t.dy * M[1] + t.dx * M[3] + M[4];
  const double rt = -t.dy * M[2] + t.dx * M[4] + M[5];
  auto& H = diagonal_sums_[at(target.from)];
  H[0] += M[0];
  H[1] += M[1];
  H[2] += rx;
  H[3] += M[3];
  H[4] += ry;
  H[5] += -t.dy * rx + t.dx * ry + rt;
  double tx = -rx;
  double ty = -ry;
  if constexpr (kHessian == Hessian::exact) {
    const auto& m = t.m;
    H[2] += m[1];
    H[4] -= m[0];
    H[5] -= m[0] * t.dx + m[1] * t.dy;
    tx -= m[1];
    ty += m[0];
  }
  if (target.to < 0) return;
  // −Tᵀ M has the rows of `from` and the columns of `to`.
  const std::array<double, 9> block{-M[0], -M[1], -M[2], -M[1], -M[3], -M[4], tx, ty, -rt};
  double* const to = factor_.data() + target.cross.offset;
  const int down = target.from > target.to ? 1 : target.cross.stride;
  const int along = target.from > target.to ? target.cross.stride : 1;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      to[row * down + column * along] += block[at(3 * row + column)];
    }
  }
}

void NormalEquations::write_diagonal(double damping) {
  for (std::size_t p = 0; p < diagonal_.size(); ++p) {
    double* const to = factor_.data() + diagonal_[p].offset;
    const int stride = diagonal_[p].stride;
    const auto& H = diagonal_sums_[p];
    to[0] = H[0] * (1.0 + damping);
    to[1] = H[1];
    to[2] = H[2];
    to[1 + stride] = H[3] * (1.0 + damping);
    to[2 + stride] = H[4];
    to[2 + 2 * stride] = H[5] * (1.0 + damping);
  }
}

bool NormalEquations::keeps_digits() const {
  for (std::size_t p = 0; p < diagonal_.size(); ++p) {
    const double* const root = factor_.data() + diagonal_[p].offset;
    const int stride = diagonal_[p].stride;
    const auto& H = diagonal_sums_[p];
    const auto is_rounding = [](double r, double sum) { return !(r * r > kLeastPivotShare * sum); };
    if (is_rounding(root[0], H[0]) || is_rounding(root[1 + stride], H[3]) ||
        is_rounding(root[2 + 2 * stride], H[5])) {
      return false;
    }
  }
  return true;
}

const std::vector<double>& NormalEquations::solve_step() {
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
  factor_.solve(step_.data());
  return step_;
}

double NormalEquations::predicted_decrease() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < step_.size(); ++i) sum -= gradient_[i] * step_[i];
  return sum;
}

double NormalEquations::gradient_norm() const {
  double largest = 0.0;
  for (const double g : gradient_) largest = std::max(largest, std::abs(g));
  return 2.0 * largest;
}

void NormalEquations::move(std::span<const Node> from, std::vector<Node>& to) const {
  to.resize(from.size());
  to[0] = from[0];
  const std::vector<int>& position = factor_.symbolic().position;
  for (std::size_t k = 1; k < from.size(); ++k) {
    const double* d = step_.data() + 3 * at(position[k - 1]);
    to[k] = make_node(from[k].x + d[0], from[k].y + d[1], from[k].theta + d[2]);
  }
}

bool NormalEquations::step_is_small(std::span<const Node> nodes, double tolerance) const {
  double step = 0.0;
  double size = 0.0;
  for (const double d : step_) step += d * d;
  for (const Node& node : nodes) {
    size += node.x * node.x + node.y * node.y + node.theta * node.theta;
  }
  return std::sqrt(step) <= tolerance * (std::sqrt(size) + tolerance);
}

}  // namespace fathom::pose_graph
