// What the errors that pictures share add to the normal equations (docs/shared_errors.md).

#include "estimators/support/pose_graph/normal_equations.hpp"

namespace fathom::pose_graph {
namespace {

// Row θ of T: [0 0; −dy dx].
Eigen::Matrix3d lever_of(const EdgeTerms& t) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T.topRightCorner<2, 1>() << -t.dy, t.dx;
  return T;
}

std::array<double, 6> upper(const Eigen::Matrix3d& matrix) {
  return {matrix(0, 0), matrix(0, 1), matrix(0, 2), matrix(1, 1), matrix(1, 2), matrix(2, 2)};
}

}  // namespace

Eigen::Matrix3d in_world(const Eigen::Matrix3d& G, const Node& from) {
  Eigen::Matrix3d A = G;
  A.row(0) = from.c * G.row(0) - from.s * G.row(1);
  A.row(1) = from.s * G.row(0) + from.c * G.row(1);
  return A;
}

void NormalEquations::add_block(sparse::BlockPlace place, int row, int column,
                                const Eigen::Matrix3d& block) {
  double* const to = factor_.data() + place.offset;
  const bool is_row_later = row > column;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      to[i + j * place.stride] += is_row_later ? block(i, j) : block(j, i);
  }
}

// g_n = Aᵀ m.
void NormalEquations::add_shared_gradient(const EdgeTerms& t, const Eigen::Matrix3d& A,
                                          int position) {
  const Eigen::Vector3d g = A.transpose() * Eigen::Vector3d(t.m[0], t.m[1], t.m[2]);
  for (int a = 0; a < 3; ++a) gradient_[3 * at(position) + at(a)] += g[a];
}

// H_nn = Aᵀ M A, H_nk = Aᵀ M, H_ni = −Aᵀ M T. The second derivatives of h have no part in them.
void NormalEquations::add_shared_end(const EdgeTerms& t, const Eigen::Matrix3d& A,
                                     const Targets& target, const SharedTargets::End& end) {
  add_shared_gradient(t, A, end.position);
  const Eigen::Matrix3d AtM = A.transpose() * full(t.M);
  const std::array<double, 6> own = upper(AtM * A);
  for (std::size_t a = 0; a < 6; ++a) diagonal_sums_[at(end.position)][a] += own[a];
  if (target.to >= 0) add_block(end.with_to, end.position, target.to, AtM);
  if (target.from >= 0) add_block(end.with_from, end.position, target.from, -AtM * lever_of(t));
}

void NormalEquations::find_shared(const sparse::Symbolic& symbolic) {
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    if (edge.shared == nullptr) continue;
    const auto end_of = [&](const SharedEnds::End& end) {
      SharedTargets::End target;
      if (end.node < 0) return target;
      target.position = position_of(symbolic, end.node);
      if (edge.from > 0) target.with_from = factor_.place(end.node - 1, edge.from - 1);
      if (edge.to > 0) target.with_to = factor_.place(end.node - 1, edge.to - 1);
      return target;
    };
    SharedTargets shared{e, end_of(edge.shared->from), end_of(edge.shared->to), {}};
    if (shared.from.position >= 0 && shared.to.position >= 0) {
      shared.between = factor_.place(edge.shared->from.node - 1, edge.shared->to.node - 1);
    }
    shared_.push_back(shared);
  }
}

void NormalEquations::add_shared_gradients(std::span<const Node> nodes) {
  for (const SharedTargets& target : shared_) {
    if (loss_.leaves_out(target.edge)) continue;
    const Edge& edge = edges_[target.edge];
    EdgeTerms t = linearise_edge(edge, nodes);
    loss_.apply(target.edge, false, t);
    const auto add = [&](const SharedEnds::End& end, int position) {
      if (position >= 0) add_shared_gradient(t, in_world(end.G, nodes[at(edge.from)]), position);
    };
    add(edge.shared->from, target.from.position);
    add(edge.shared->to, target.to.position);
  }
}

// With P = diag(Rot(−θ_i), 1) the Jacobian of ν by n is G = P A, so that M and m serve for it.
double NormalEquations::add_shared(std::span<const Node> nodes, Hessian hessian) {
  const Lever lever = hessian == Hessian::measured ? Lever::measured : Lever::estimated;
  for (const SharedTargets& shared : shared_) {
    if (loss_.leaves_out(shared.edge)) continue;
    const Edge& edge = edges_[shared.edge];
    EdgeTerms t = linearise_edge(edge, nodes, lever);
    loss_.apply(shared.edge, hessian == Hessian::exact, t);
    const Targets& target = targets_[shared.edge];
    const Eigen::Matrix3d A_from = in_world(edge.shared->from.G, nodes[at(edge.from)]);
    const Eigen::Matrix3d A_to = in_world(edge.shared->to.G, nodes[at(edge.from)]);
    if (shared.from.position >= 0) add_shared_end(t, A_from, target, shared.from);
    if (shared.to.position >= 0) add_shared_end(t, A_to, target, shared.to);
    if (shared.from.position < 0 || shared.to.position < 0) continue;
    add_block(shared.between, shared.from.position, shared.to.position,
              A_from.transpose() * full(t.M) * A_to);
  }
  return add_priors(nodes, true);
}

double NormalEquations::add_priors(std::span<const Node> nodes, bool with_matrix) {
  double cost = 0.0;
  for (std::size_t k = keyframes_of(nodes); k < nodes.size(); ++k) {
    const std::array n{nodes[k].x, nodes[k].y, nodes[k].theta};
    const std::size_t position = at(position_of(factor_.symbolic(), static_cast<int>(k)));
    for (std::size_t a = 0; a < 3; ++a) {
      cost += n[a] * n[a];
      gradient_[3 * position + a] += n[a];
    }
    if (!with_matrix) continue;
    for (const std::size_t a : {0U, 3U, 5U}) diagonal_sums_[position][a] += 1.0;
  }
  return cost;
}

}  // namespace fathom::pose_graph
