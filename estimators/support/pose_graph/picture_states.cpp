#include "estimators/support/pose_graph/picture_states.hpp"

#include <algorithm>

#include "fathom/geometry/covariance.hpp"

namespace fathom::pose_graph {

void PictureStates::add(const RelativePose& z, std::size_t edge) {
  told_.push_back(
      {edge, z.from, z.to, z.shared->from.scaled(), z.shared->to.scaled(), z.shared->own});
  pictures_.resize(std::max(pictures_.size(), z.newest() + 1));
  ++pictures_[z.from].registrations;
  ++pictures_[z.to].registrations;
}

void PictureStates::forget_from(std::size_t edge) {
  while (!told_.empty() && told_.back().edge >= edge) {
    --pictures_[told_.back().from].registrations;
    --pictures_[told_.back().to].registrations;
    told_.pop_back();
  }
}

ExtendedGraph PictureStates::extended(std::span<const Edge> edges,
                                      std::span<const Node> nodes) const {
  ExtendedGraph graph;
  graph.edges = edges;
  graph.nodes.assign(nodes.begin(), nodes.end());
  if (is_empty()) return graph;
  graph.own_edges.assign(edges.begin(), edges.end());
  graph.edges = graph.own_edges;
  graph.node_of.assign(pictures_.size(), -1);
  for (std::size_t k = 0; k < pictures_.size(); ++k) {
    const auto& [registrations, n] = pictures_[k];
    if (registrations <= (folds_singles_ ? 1 : 0)) continue;
    graph.node_of[k] = static_cast<int>(graph.nodes.size());
    graph.nodes.push_back(make_errors(n[0], n[1], n[2]));
  }
  graph.ends.reserve(told_.size());
  for (const Told& told : told_) {
    const SharedEnds ends{{graph.node_of[told.from], told.G_from},
                          {graph.node_of[told.to], told.G_to}};
    Eigen::Matrix3d own = told.own;
    if (ends.from.node < 0) own += told.G_from * told.G_from.transpose();
    if (ends.to.node < 0) own += told.G_to * told.G_to.transpose();
    const Eigen::Matrix3d W = symmetric_inverse(own);
    Edge& edge = graph.own_edges[told.edge];
    edge.W = {W(0, 0), W(0, 1), W(0, 2), W(1, 1), W(1, 2), W(2, 2)};
    edge.rows = nullptr;
    if (ends.from.node < 0 && ends.to.node < 0) continue;
    graph.ends.push_back(ends);
    edge.shared = &graph.ends.back();
  }
  return graph;
}

void PictureStates::keep(const ExtendedGraph& solved) {
  for (std::size_t k = 0; k < solved.node_of.size(); ++k) {
    if (solved.node_of[k] < 0) continue;
    const Node& n = solved.nodes[at(solved.node_of[k])];
    pictures_[k].n = {n.x, n.y, n.theta};
  }
}

void PictureStates::reset() {
  for (Picture& picture : pictures_) picture.n.setZero();
}

Eigen::Vector3d PictureStates::errors_of(std::size_t keyframe) const {
  return keyframe < pictures_.size() ? pictures_[keyframe].n : Eigen::Vector3d::Zero().eval();
}

RelativePose PictureStates::without_errors(const RelativePose& z) const {
  if (!z.shared) return z;
  return without_shared(
      z, z.shared->from.scaled() * errors_of(z.from) + z.shared->to.scaled() * errors_of(z.to));
}

}  // namespace fathom::pose_graph
