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

double NormalEquations::linearise(std::span<const Node> nodes, Hessian hessian, double damping,
                                  std::span<const PairTerms> given) {
  factor_.clear();
  has_factor_ = false;
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  has_begun_step_ = false;
  std::fill(diagonal_sums_.begin(), diagonal_sums_.end(), std::array<double, 6>{});
  double cost = 0.0;
  switch (hessian) {
    case Hessian::gauss_newton:
      cost = add_edges<Hessian::gauss_newton>(nodes, given);
      break;
    case Hessian::measured:
      cost = add_edges<Hessian::measured>(nodes, given);
      break;
    case Hessian::exact:
      cost = add_edges<Hessian::exact>(nodes, given);
      break;
    case Hessian::positions:
      cost = add_edges<Hessian::positions>(nodes, given);
      break;
  }
  if (!is_pose(nodes.back())) cost += add_shared(nodes, hessian);
  write_diagonal(damping);
  return cost;
}

template <Hessian kHessian>
double NormalEquations::add_edges(std::span<const Node> nodes, std::span<const PairTerms> given) {
  return parts_.sum([&](std::size_t e, const auto& part) {
    const Targets& target = targets_[e];
    const auto add = [&](const PairTerms& t) {
      add_gradient(t, part, target);
      add_matrix(t, part, target);
      return t.cost;
    };
    if (e < given.size()) return add(given[e]);
    if (loss_.leaves_out(e)) return 0.0;
    EdgeTerms t = linearise_edge(edges_[e], nodes, kLeverOf<kHessian>);
    loss_.apply(e, kHessian == Hessian::exact, t);
    return add(pair_terms<kHessian>(t));
  });
}

double NormalEquations::differentiate(std::span<const Node> nodes,
                                      std::span<const PairTerms> given) {
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  has_begun_step_ = false;
  const double cost = parts_.sum([&](std::size_t e, const auto& part) {
    const auto add = [&](const PairTerms& t) {
      add_gradient(t, part, targets_[e]);
      return t.cost;
    };
    if (e < given.size()) return add(given[e]);
    if (loss_.leaves_out(e)) return 0.0;
    EdgeTerms t = linearise_edge(edges_[e], nodes);
    loss_.apply(e, false, t);
    return add(pair_terms<Hessian::gauss_newton>(t));
  });
  if (is_pose(nodes.back())) return cost;
  add_shared_gradients(nodes);
  return cost + add_priors(nodes, false);
}

template <class Part>
inline void NormalEquations::add_gradient(const PairTerms& t, const Part& part,
                                          const Targets& target) {
  const auto add = [&](const std::array<double, 3>& g, int position) {
    if (!part.has(position)) return;
    double* const to = gradient_.data() + 3 * at(position);
    for (int a = 0; a < 3; ++a) to[a] += g[at(a)];
  };
  add(t.g_to, target.to);
  add(t.g_from, target.from);
}

// Each where the part has it; H_cross where both ends are free.
template <class Part>
inline void NormalEquations::add_matrix(const PairTerms& t, const Part& part,
                                        const Targets& target) {
  const auto add = [&](const std::array<double, 6>& H, int position) {
    if (!part.has(position)) return;
    auto& to = diagonal_sums_[at(position)];
    for (std::size_t a = 0; a < 6; ++a) to[a] += H[a];
  };
  add(t.H_to, target.to);
  add(t.H_from, target.from);
  if (!part.has(std::min(target.from, target.to))) return;
  double* const to = factor_.data() + target.cross.offset;
  const int down = target.from > target.to ? 1 : target.cross.stride;
  const int along = target.from > target.to ? target.cross.stride : 1;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      to[row * down + column * along] += t.H_cross[at(3 * row + column)];
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

bool NormalEquations::factorise(sparse::Inertia inertia) {
  has_begun_step_ = true;
  for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
  const bool is_done = factor_.factorise(inertia, step_.data());
  has_factor_ = is_done && factor_.negative_pivots() == 0;
  return is_done;
}

const std::vector<double>& NormalEquations::solve_step() {
  if (has_begun_step_) {
    factor_.solve_begun(step_.data());
  } else {
    for (std::size_t i = 0; i < step_.size(); ++i) step_[i] = -gradient_[i];
    factor_.solve(step_.data());
  }
  has_begun_step_ = false;
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
      to[node + 1] = is_pose(pose) ? moved(pose, d[0], d[1], d[2])
                                   : make_errors(pose.x + d[0], pose.y + d[1], pose.theta + d[2]);
    }
  });
}

bool NormalEquations::step_is_small(std::span<const Node> nodes, double tolerance) const {
  double step = 0.0;
  for (const double d : step_) step += d * d;
  return is_small(step, nodes, tolerance);
}

// A share of coordinates whose origin is node 0 (AnchoredEstimator).
bool is_small(double squared_step, std::span<const Node> nodes, double tolerance) {
  double size = 0.0;
  for (const Node& node : nodes) {
    size += node.x * node.x + node.y * node.y + node.theta * node.theta;
  }
  return std::sqrt(squared_step) <= tolerance * (std::sqrt(size) + tolerance);
}

}  // namespace fathom::pose_graph
