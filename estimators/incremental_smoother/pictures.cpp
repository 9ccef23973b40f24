#include "estimators/incremental_smoother/pictures.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

#include "fathom/geometry/covariance.hpp"

namespace fathom::incremental_smoother {

using pose_graph::ExtendedGraph;
using pose_graph::SharedEnds;

void Pictures::set_edge(Told& told, std::vector<Edge>& edges) {
  Eigen::Matrix3d C = told.own;
  for (const SharedEnds::End* end : {&told.ends.from, &told.ends.to}) {
    if (end->node < 0) C += end->G * end->G.transpose();
  }
  const Eigen::Matrix3d W = symmetric_inverse(C);
  Edge& edge = edges[at(told.edge)];
  edge.W = {W(0, 0), W(0, 1), W(0, 2), W(1, 1), W(1, 2), W(2, 2)};
  edge.rows = nullptr;
  edge.shared = told.ends.from.node < 0 && told.ends.to.node < 0 ? nullptr : &told.ends;
}

void Pictures::set_unknown(int keyframe, bool is_unknown) {
  errors.resize(std::max(errors.size(), at(keyframe) + 1), pose_graph::make_errors(0, 0, 0));
  errors[at(keyframe)] = pose_graph::make_errors(0, 0, 0);
  pictures_[at(keyframe)].is_unknown = is_unknown;
}

int Pictures::folded_edge(int keyframe) const {
  if (!folds_singles_ || at(keyframe) >= pictures_.size()) return -1;
  const Picture& picture = pictures_[at(keyframe)];
  return picture.registrations == 1 ? told_[picture.first].edge : -1;
}

// n̂ = −(I + Gᵀ W G)⁻¹ Gᵀ W ν.
void Pictures::unfold(int keyframe, std::vector<Edge>& edges, std::span<const Node> poses) {
  Told& told = told_[pictures_[at(keyframe)].first];
  Edge& edge = edges[at(told.edge)];
  set_unknown(keyframe, true);
  SharedEnds::End& end = end_of(told, edge, keyframe);
  end.node = keyframe;
  set_edge(told, edges);
  const Eigen::Matrix3d GtW = end.G.transpose() * pose_graph::full(edge.W);
  const Eigen::Matrix3d H = Eigen::Matrix3d::Identity() + GtW * end.G;
  const Eigen::Vector3d n = -H.llt().solve(GtW * residual(edge, poses));
  errors[at(keyframe)] = pose_graph::make_errors(n[0], n[1], n[2]);
}

void Pictures::add(const SharedErrors& shared, std::vector<Edge>& edges) {
  const Edge& edge = edges.back();
  pictures_.resize(std::max(pictures_.size(), at(std::max(edge.from, edge.to)) + 1));
  Told& told = told_.emplace_back();
  told.edge = static_cast<int>(edges.size()) - 1;
  told.own = shared.own;
  told.ends.from.G = shared.from.scaled();
  told.ends.to.G = shared.to.scaled();
  for (const int k : {edge.from, edge.to}) {
    Picture& picture = pictures_[at(k)];
    if (picture.registrations++ == 0) {
      picture.first = told_.size() - 1;
      if (!folds_singles_) set_unknown(k, true);
    }
    if (picture.is_unknown) end_of(told, edge, k).node = k;
  }
  set_edge(told, edges);
}

void Pictures::forget(int count, std::vector<Edge>& edges) {
  while (!told_.empty() && told_.back().edge >= count) {
    const Edge gone = edges[at(told_.back().edge)];
    told_.pop_back();
    for (const int k : {gone.from, gone.to}) {
      Picture& picture = pictures_[at(k)];
      if (--picture.registrations != (folds_singles_ ? 1 : 0)) continue;
      if (!picture.is_unknown) continue;
      set_unknown(k, false);
      if (picture.registrations == 0) continue;
      Told& single = told_[picture.first];
      end_of(single, edges[at(single.edge)], k).node = -1;
      set_edge(single, edges);
    }
  }
}

ExtendedGraph Pictures::extended(std::vector<Edge> edges, std::span<const Node> poses) const {
  ExtendedGraph graph;
  graph.nodes.assign(poses.begin(), poses.end());
  graph.own_edges = std::move(edges);
  graph.edges = graph.own_edges;
  graph.node_of.assign(pictures_.size(), -1);
  for (std::size_t k = 0; k < pictures_.size(); ++k) {
    if (!pictures_[k].is_unknown) continue;
    graph.node_of[k] = static_cast<int>(graph.nodes.size());
    graph.nodes.push_back(errors[k]);
  }
  graph.ends.reserve(told_.size());
  for (const Told& told : told_) {
    Edge& edge = graph.own_edges[at(told.edge)];
    if (edge.shared == nullptr) continue;
    SharedEnds& ends = graph.ends.emplace_back(told.ends);
    for (SharedEnds::End* end : {&ends.from, &ends.to}) {
      if (end->node >= 0) end->node = graph.node_of[at(end->node)];
    }
    edge.shared = &ends;
  }
  return graph;
}

void Pictures::keep(const ExtendedGraph& solved) {
  for (std::size_t k = 0; k < solved.node_of.size(); ++k) {
    if (solved.node_of[k] >= 0) errors[k] = solved.nodes[at(solved.node_of[k])];
  }
}

Eigen::Vector3d Pictures::residual(const Edge& edge, std::span<const Node> poses) const {
  const Edge left = edge.shared == nullptr ? edge : pose_graph::without_errors(edge, errors);
  return pose_graph::residual_of(left, poses[at(edge.from)], poses[at(edge.to)]);
}

// Given ν, n of a picture that is folded with G has the mean −Gᵀ W ν and the covariance 1 − Gᵀ W G,
// W that of the edge as it is folded.
std::vector<Pictures::Folded> Pictures::folded_of(const RelativePose& z,
                                                  std::span<const Edge> edges) const {
  std::vector<Folded> all;
  const auto add = [&](std::size_t keyframe, const Eigen::Matrix3d& G) {
    const int e = folded_edge(static_cast<int>(keyframe));
    if (e < 0) return;
    const Told& told = told_[pictures_[keyframe].first];
    const bool is_from = at(edges[at(e)].from) == keyframe;
    if (all.empty() || all.back().edge != e) all.emplace_back().edge = e;
    all.back().X += G * (is_from ? told.ends.from : told.ends.to).G.transpose();
  };
  add(z.from, z.shared->from.scaled());
  add(z.to, z.shared->to.scaled());
  return all;
}

RelativePose Pictures::without_errors(const RelativePose& z, std::span<const Edge> edges,
                                      std::span<const Node> poses) const {
  Eigen::Vector3d error =
      z.shared->from.scaled() * n_of(z.from) + z.shared->to.scaled() * n_of(z.to);
  for (const auto& [e, X] : folded_of(z, edges)) {
    const Edge& edge = edges[at(e)];
    error -= X * pose_graph::full(edge.W) * residual(edge, poses);
  }
  return without_shared(z, error);
}

Eigen::Vector3d Pictures::n_of(std::size_t keyframe) const {
  if (keyframe >= errors.size()) return Eigen::Vector3d::Zero();
  const Node& n = errors[keyframe];
  return {n.x, n.y, n.theta};
}

}  // namespace fathom::incremental_smoother
