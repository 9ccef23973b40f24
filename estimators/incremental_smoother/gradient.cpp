#include "estimators/incremental_smoother/gradient.hpp"

#include <algorithm>

namespace fathom::incremental_smoother {

void Gradient::add_edge() {
  terms_.emplace_back();
  evaluate(problem_.edge_count() - 1);
}

inline void Gradient::replace(int e, const EdgeGradient& next) {
  const Edge& edge = problem_.edges[at(e)];
  EdgeGradient& t = terms_[at(e)];
  Vec3& from = by_variable_.poses[at(edge.from)];
  Vec3& to = by_variable_.poses[at(edge.to)];
  for (std::size_t a = 0; a < 3; ++a) {
    from[a] += next.from[a] - t.from[a];
    to[a] += next.to[a] - t.to[a];
  }
  if (edge.shared != nullptr) {
    grow_errors();
    add_errors(edge, t, -1.0);
    add_errors(edge, next, 1.0);
  }
  cost_ += next.cost - t.cost;
  t = next;
}

void Gradient::take_out(int e) {
  replace(e, {});
}

void Gradient::evaluate(int e) {
  const Edge& edge = problem_.edges[at(e)];
  const Node& i = problem_.nodes[at(edge.from)];
  const Node& k = problem_.nodes[at(edge.to)];
  EdgeGradient next =
      edge.shared == nullptr
          ? gradient_of(edge, i, k)
          : gradient_of(pose_graph::without_errors(edge, problem_.pictures.errors), i, k);
  if (problem_.loops.is_on()) problem_.loops.apply(e, next);
  replace(e, next);
}

// Gᵀ W ν. W ν is that of the gradient at `from`, but for the lever.
void Gradient::add_errors(const Edge& edge, const EdgeGradient& t, double sign) {
  const Eigen::Vector3d Wv = sign * Eigen::Vector3d(-t.from[0], -t.from[1], t.to[2]);
  for (const pose_graph::SharedEnds::End* end : {&edge.shared->from, &edge.shared->to}) {
    if (end->node < 0) continue;
    const Eigen::Vector3d g = end->G.transpose() * Wv;
    for (int a = 0; a < 3; ++a) by_variable_.errors[at(end->node)][at(a)] += g[a];
  }
}

void Gradient::grow_errors() {
  by_variable_.errors.resize(problem_.error_count());
  priors_.resize(problem_.error_count());
}

void Gradient::evaluate_prior(int keyframe) {
  grow_errors();
  const Node& n = problem_.pictures.errors[at(keyframe)];
  const Vec3 next{n.x, n.y, n.theta};
  Vec3& was = priors_[at(keyframe)];
  for (std::size_t a = 0; a < 3; ++a) {
    by_variable_.errors[at(keyframe)][a] += next[a] - was[a];
    cost_ += next[a] * next[a] - was[a] * was[a];
  }
  was = next;
}

void Gradient::evaluate_all() {
  cost_ = 0.0;
  by_variable_.fill({});
  std::ranges::fill(priors_, Vec3{});
  terms_.assign(at(problem_.edge_count()), EdgeGradient{});
  for (int e = 0; e < problem_.edge_count(); ++e) evaluate(e);
  for (std::size_t k = 0; k < problem_.error_count(); ++k) evaluate_prior(static_cast<int>(k));
}

}  // namespace fathom::incremental_smoother
