#include "estimators/incremental_smoother/gradient.hpp"

#include <algorithm>

namespace fathom::incremental_smoother {

void Gradient::add_edge() {
  terms_.emplace_back();
  evaluate(problem_.edge_count() - 1);
}

void Gradient::evaluate(int e) {
  const Edge& edge = problem_.edges[at(e)];
  EdgeGradient& t = terms_[at(e)];
  EdgeGradient next = gradient_of(edge, problem_.nodes[at(edge.from)], problem_.nodes[at(edge.to)]);
  if (problem_.loops.is_on()) problem_.loops.apply(e, next);
  Vec3& from = by_keyframe_[at(edge.from)];
  Vec3& to = by_keyframe_[at(edge.to)];
  for (std::size_t a = 0; a < 3; ++a) {
    from[a] += next.from[a] - t.from[a];
    to[a] += next.to[a] - t.to[a];
  }
  cost_ += next.cost - t.cost;
  t = next;
}

void Gradient::evaluate_all() {
  cost_ = 0.0;
  std::fill(by_keyframe_.begin(), by_keyframe_.end(), Vec3{});
  terms_.assign(at(problem_.edge_count()), EdgeGradient{});
  for (int e = 0; e < problem_.edge_count(); ++e) evaluate(e);
}

}  // namespace fathom::incremental_smoother
