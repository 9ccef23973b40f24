#include "estimators/support/pose_graph/chains.hpp"

#include "estimators/support/pose_graph/step_lever.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::pose_graph {
namespace {

/// Keyframes that are left, of all, at most. Not tuned: where two thirds are left, the elimination
/// of chains saves a few percent.
constexpr double kMostLeft = 0.8;
/// With more the solve of the rest costs too much.
constexpr double kMostLeftToStart = 0.5;

}  // namespace

ChainGraph::ChainGraph(std::span<const Edge> edges, std::span<const Node> nodes)
    : all_(edges), keyframes_(nodes.size()) {
  if (keyframes_of(nodes) != nodes.size() || !find_chains(nodes.size())) return;
  for (const Chain& chain : chains_) nodes_.push_back(nodes[at(chain.begin)]);
  const Chain& last = chains_.back();
  if (!last.is_open) nodes_.push_back(nodes[at(last.begin + last.count)]);
  has_chains_ = is_share(nodes_.size(), kMostLeft) && find_edges();
}

bool ChainGraph::is_share(std::size_t left, double most) const {
  return static_cast<double>(left) < most * static_cast<double>(keyframes_);
}

bool ChainGraph::measure() {
  if (!has_chains_ || !is_share(chains_.size(), kMostLeftToStart) || !find_covariances()) {
    return false;
  }
  paths_.resize(keyframes_ + chains_.size());
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    if (!chains_[i].is_open && chains_[i].count > 1) measure(i);
  }
  return true;
}

// False where errors of pictures are unknowns, or a keyframe that is left out is not where its
// steps lead.
bool ChainGraph::find_edges() {
  const Chain& last = chains_.back();
  for (int t = 0; last.is_open && t < last.count; ++t) {
    if (!covariance_of_step(step(last, t))) return false;
  }
  std::vector<int> node_of(keyframes_, -1);
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    node_of[at(chains_[i].begin)] = static_cast<int>(i);
  }
  if (!last.is_open) node_of[at(last.begin + last.count)] = static_cast<int>(chains_.size());
  edges_.reserve(chains_.size() + all_.size() - keyframes_ + 1);
  for (const Chain& chain : chains_) {
    if (chain.is_open) continue;
    Edge edge = chain.count == 1 ? step(chain, 0) : Edge{};
    edge.from = chain.begin;
    edge.to = chain.begin + chain.count;
    edges_.push_back(edge);
  }
  for (std::size_t e = 0; e < all_.size(); ++e) {
    const Edge& edge = all_[e];
    if (edge.shared != nullptr) return false;
    if (edge.to == edge.from + 1 && steps_[at(edge.from)] == static_cast<int>(e)) continue;
    edges_.push_back(edge);
  }
  for (Edge& edge : edges_) {
    edge.from = node_of[at(edge.from)];
    edge.to = node_of[at(edge.to)];
  }
  return true;
}

bool ChainGraph::find_covariances() {
  covariances_.resize(keyframes_);
  for (const Chain& chain : chains_) {
    for (int t = 0; t < chain.count; ++t) {
      const auto C = covariance_of_step(step(chain, t));
      if (!C) return false;
      covariances_[at(chain.begin + t)] = *C;
    }
  }
  return true;
}

// False where there is a keyframe that no step leads to.
bool ChainGraph::find_chains(std::size_t keyframes) {
  std::vector<int> degree(keyframes, 0);
  steps_.assign(keyframes, -1);
  for (std::size_t e = 0; e < all_.size(); ++e) {
    const Edge& edge = all_[e];
    ++degree[at(edge.from)];
    ++degree[at(edge.to)];
    if (edge.to == edge.from + 1 && steps_[at(edge.from)] < 0) {
      steps_[at(edge.from)] = static_cast<int>(e);
    }
  }
  const int last = static_cast<int>(keyframes) - 1;
  for (int k = 0; k < last; ++k) {
    if (steps_[at(k)] < 0) return false;
    if (k == 0 || degree[at(k)] != 2) chains_.push_back({k, 0, false});
    ++chains_.back().count;
  }
  if (chains_.empty()) return false;
  chains_.back().is_open = degree[at(last)] == 1;
  return true;
}

void ChainGraph::measure(std::size_t i) {
  const Chain& chain = chains_[i];
  Node* const path = path_of(i);
  path[0] = Node{};
  for (int t = 0; t < chain.count; ++t) path[t + 1] = behind(path[t], step(chain, t));
  const Node& last = path[chain.count];
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int t = 0; t < chain.count; ++t) {
    sum += lever_of(path[t], path[t + 1], last).moved(covariances_[at(chain.begin + t)]);
  }
  const Eigen::Matrix3d W = symmetric_inverse(sum);
  Edge& edge = edges_[i];
  edge.x = last.x;
  edge.y = last.y;
  edge.theta = last.theta;
  edge.W = {W(0, 0), W(0, 1), W(0, 2), W(1, 1), W(1, 2), W(2, 2)};
}

// ν of the steps: minimise Σ νᵀ W ν so that they end at `end`, in the frame of the begin. With the
// levers A at a path, ν = C Aᵀ λ, and λ makes Σ A ν what the end lacks of the path that is
// measured: with the levers of that path first, then with those of the path which that gives.
void ChainGraph::expand(std::size_t i, const Node& end, Expansion& work,
                        std::vector<Node>& all) const {
  const Chain& chain = chains_[i];
  const Node* const measured = path_of(i);
  const Eigen::Vector3d lacks = residual_of(edges_[i], all[at(chain.begin)], end);
  std::vector<Node>& path = work.path;
  path.assign(measured, measured + chain.count + 1);
  work.errors.assign(at(chain.count), Eigen::Vector3d::Zero());
  const auto correct = [&](const Eigen::Vector3d& force) {
    for (int t = 0; t < chain.count; ++t) {
      work.errors[at(t)] = covariances_[at(chain.begin + t)] *
                           lever_of(path[at(t)], path[at(t) + 1], path.back()).back(force);
    }
  };
  correct(full(edges_[i].W) * lacks);
  double turn = 0.0;
  for (int t = 0; t < chain.count; ++t) {
    const Eigen::Vector3d& error = work.errors[at(t)];
    const Eigen::Vector2d end_at = place_behind(path[at(t)], step(chain, t), error);
    turn += error.z();
    path[at(t) + 1] = moved(measured[t + 1], end_at.x() - measured[t + 1].x,
                            end_at.y() - measured[t + 1].y, turn);
  }
  const Node& last = measured[chain.count];
  Eigen::Vector3d still = lacks;
  still -= Eigen::Vector3d(path.back().x - last.x, path.back().y - last.y, turn);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int t = 0; t < chain.count; ++t) {
    const StepLever lever = lever_of(path[at(t)], path[at(t) + 1], path.back());
    sum += lever.moved(covariances_[at(chain.begin + t)]);
    still += lever.along(work.errors[at(t)]);
  }
  correct(symmetric_inverse(sum) * still);
  for (int t = 0; t + 1 < chain.count; ++t) {
    const std::size_t k = at(chain.begin + t);
    all[k + 1] = behind(all[k], step(chain, t), work.errors[at(t)]);
  }
}

std::vector<Node> ChainGraph::expanded(std::span<const Node> nodes) const {
  std::vector<Node> all(keyframes_);
  Expansion work;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const Chain& chain = chains_[i];
    all[at(chain.begin)] = nodes[i];
    if (chain.is_open) continue;
    if (chain.count > 1) expand(i, nodes[i + 1], work, all);
    all[at(chain.begin + chain.count)] = nodes[i + 1];
  }
  follow_open_chain(all);
  return all;
}

void ChainGraph::follow_open_chain(std::vector<Node>& all) const {
  const Chain& last = chains_.back();
  for (int t = 0; last.is_open && t < last.count; ++t) {
    const std::size_t k = at(last.begin + t);
    all[k + 1] = behind(all[k], step(last, t));
  }
}

}  // namespace fathom::pose_graph
