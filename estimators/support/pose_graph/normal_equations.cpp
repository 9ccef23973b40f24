#include "estimators/support/pose_graph/normal_equations.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/estimation/precision.hpp"

namespace fathom::pose_graph {
NormalEquations::NormalEquations(const sparse::Symbolic& symbolic, std::span<const Edge> edges)
    : edges_(edges),
      parts_(symbolic, edges),
      factor_(symbolic),
      targets_(edges.size()),
      diagonal_(at(symbolic.size())),
      diagonal_sums_(at(symbolic.size())),
      gradient_(3 * at(symbolic.size())),
      step_(3 * at(symbolic.size())) {
  for_ranges(workers(), edges.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      Targets& t = targets_[e];
      t.from = position_of(symbolic, edges[e].from);
      t.to = position_of(symbolic, edges[e].to);
      if (t.from < 0 || t.to < 0) continue;
      t.cross = factor_.place(edges[e].from - 1, edges[e].to - 1);
    }
  });
  for_ranges(workers(), diagonal_.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      diagonal_[p] = factor_.place(symbolic.node[p], symbolic.node[p]);
    }
  });
  find_shared(symbolic);
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
  if (!is_pose(nodes.back())) cost += add_shared(nodes, hessian);
  write_diagonal(damping);
  return cost;
}

template <Hessian kHessian>
double NormalEquations::add_edges(std::span<const Node> nodes) {
  constexpr Lever kLever = kHessian == Hessian::measured ? Lever::measured : Lever::estimated;
  return parts_.sum([&](std::size_t e, const auto& part) {
    if (loss_.leaves_out(e)) return 0.0;
    const Edge& edge = edges_[e];
    EdgeTerms t = linearise_edge(edge, nodes, kLever);
    loss_.apply(e, kHessian == Hessian::exact, t);
    const Targets& target = targets_[e];
    if (part.has(target.to)) {
      add_gradient_at_end(t, target.to);
      add_to_end(t, target.to);
    }
    if (part.has(target.from)) add_gradient_at_begin(t, target.from);
    add_to_begin<kHessian>(t, part, target);
    return t.cost;
  });
}

double NormalEquations::differentiate(std::span<const Node> nodes) {
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  const double cost = parts_.sum([&](std::size_t e, const auto& part) {
    if (loss_.leaves_out(e)) return 0.0;
    EdgeTerms t = linearise_edge(edges_[e], nodes);
    loss_.apply(e, false, t);
    const Targets& target = targets_[e];
    if (part.has(target.to)) add_gradient_at_end(t, target.to);
    if (part.has(target.from)) add_gradient_at_begin(t, target.from);
    return t.cost;
  });
  if (is_pose(nodes.back())) return cost;
  add_shared_gradients(nodes);
  return cost + add_priors(nodes, false);
}

// g_k = m.
inline void NormalEquations::add_gradient_at_end(const EdgeTerms& t, int position) {
  double* g = gradient_.data() + 3 * at(position);
  for (int a = 0; a < 3; ++a) g[a] += t.m[at(a)];
}

// g_i = −Tᵀ m.
inline void NormalEquations::add_gradient_at_begin(const EdgeTerms& t, int position) {
  const auto& m = t.m;
  double* g = gradient_.data() + 3 * at(position);
  g[0] -= m[0];
  g[1] -= m[1];
  g[2] -= -t.dy * m[0] + t.dx * m[1] + m[2];
}

// H_kk.
inline void NormalEquations::add_to_end(const EdgeTerms& t, int position) {
  auto& H = diagonal_sums_[at(position)];
  for (std::size_t a = 0; a < 6; ++a) H[a] += t.M[a];
}

// H_ii, and H_ik where k is free; each where the part has it.
template <Hessian kHessian, class Part>
inline void NormalEquations::add_to_begin(const EdgeTerms& t, const Part& part,
                                          const Targets& target) {
  const auto& M = t.M;
  // Row θ of Tᵀ M, and below element (θ, θ) of Tᵀ M T.
  const double rx = -t.dy * M[0] + t.dx * M[1] + M[2];
  const double ry = -t.dy * M[1] + t.dx * M[3] + M[4];
  const double rt = -t.dy * M[2] + t.dx * M[4] + M[5];
  const auto& m = t.m;
  if (part.has(target.from)) {
    auto& H = diagonal_sums_[at(target.from)];
    H[0] += M[0];
    H[1] += M[1];
    H[2] += rx;
    H[3] += M[3];
    H[4] += ry;
    H[5] += -t.dy * rx + t.dx * ry + rt;
    if constexpr (kHessian == Hessian::exact) {
      H[2] += m[1];
      H[4] -= m[0];
      H[5] -= m[0] * t.dx + m[1] * t.dy;
    }
  }
  if (!part.has(std::min(target.from, target.to))) return;
  const double tx = kHessian == Hessian::exact ? -rx - m[1] : -rx;
  const double ty = kHessian == Hessian::exact ? -ry + m[0] : -ry;
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
  for_ranges(workers(), diagonal_.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
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
  });
}

bool NormalEquations::factorise_at(std::span<const Node> nodes) {
  const auto is_wide = [](const Edge& edge) { return edge.rows != nullptr; };
  if (std::ranges::any_of(edges_, is_wide)) return false;
  linearise(nodes, Hessian::gauss_newton);
  return factorise() && negative_pivots() == 0 && keeps_digits();
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
  for_ranges(workers(), position.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const double* d = step_.data() + 3 * at(position[node]);
      const Node& pose = from[node + 1];
      to[node + 1] = is_pose(pose) ? make_node(pose.x + d[0], pose.y + d[1], pose.theta + d[2])
                                   : make_errors(pose.x + d[0], pose.y + d[1], pose.theta + d[2]);
    }
  });
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
