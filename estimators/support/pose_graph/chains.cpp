#include "estimators/support/pose_graph/chains.hpp"

#include <cmath>
#include <optional>

#include "fathom/geometry/covariance.hpp"

namespace fathom::pose_graph {
namespace {

/// Keyframes that are left, of all, at most: with more the solve of the rest costs too much.
constexpr double kMostLeft = 0.5;

/// Corrections of a chain: each squares the error of the one before.
constexpr int kPasses = 2;

/// What an error of a step, in the axes of the keyframe it begins at, does to the end of its chain:
/// A = [R  (−dy, dx)ᵀ; 0 1], R the turn of the step's begin, (dx, dy) from the step's end to the
/// chain's.
struct StepLever {
  double c = 1.0;
  double s = 0.0;
  double dx = 0.0;
  double dy = 0.0;

  Eigen::Vector3d along(const Eigen::Vector3d& error) const {
    return {c * error.x() - s * error.y() - dy * error.z(),
            s * error.x() + c * error.y() + dx * error.z(), error.z()};
  }
  /// Aᵀ λ.
  Eigen::Vector3d back(const Eigen::Vector3d& force) const {
    return {c * force.x() + s * force.y(), -s * force.x() + c * force.y(),
            -dy * force.x() + dx * force.y() + force.z()};
  }
  /// A C Aᵀ.
  Eigen::Matrix3d moved(const Eigen::Matrix3d& C) const {
    Eigen::Matrix3d half;
    for (int i = 0; i < 3; ++i) half.col(i) = along(C.col(i));
    Eigen::Matrix3d whole;
    for (int i = 0; i < 3; ++i) whole.col(i) = along(half.row(i).transpose());
    return whole;
  }
};

StepLever lever_of(const Node& begin, const Node& end, const Node& last) {
  return {begin.c, begin.s, last.x - end.x, last.y - end.y};
}

/// W⁻¹ by its cofactors; nothing where W is that of fewer than three coordinates, or near it.
std::optional<Eigen::Matrix3d> covariance_of_step(const Edge& edge) {
  constexpr double kLeastShare = 1e-9;
  if (edge.shared != nullptr || edge.rows != nullptr) return std::nullopt;
  const auto& [xx, xy, xt, yy, yt, tt] = edge.W;
  const double a = yy * tt - yt * yt;
  const double b = xt * yt - xy * tt;
  const double c = xy * yt - xt * yy;
  const double determinant = xx * a + xy * b + xt * c;
  if (!(determinant > kLeastShare * xx * yy * tt)) return std::nullopt;
  Eigen::Matrix3d C;
  C << a, b, c, b, xx * tt - xt * xt, xy * xt - xx * yt, c, xy * xt - xx * yt, xx * yy - xy * xy;
  return C / determinant;
}

}  // namespace

ChainGraph::ChainGraph(std::span<const Edge> edges, std::span<const Node> nodes)
    : all_(edges), keyframes_(nodes.size()) {
  if (keyframes_of(nodes) != nodes.size() || !find_chains(nodes.size())) return;
  covariances_.resize(keyframes_);
  for (const Chain& chain : chains_) {
    for (int t = 0; t < chain.count; ++t) {
      const auto C = covariance_of_step(step(chain, t));
      if (!C) return;
      covariances_[at(chain.begin + t)] = *C;
    }
  }
  std::vector<int> node_of(keyframes_, -1);
  for (const Chain& chain : chains_) {
    node_of[at(chain.begin)] = static_cast<int>(nodes_.size());
    nodes_.push_back(nodes[at(chain.begin)]);
  }
  const Chain& last = chains_.back();
  if (!last.is_open) {
    node_of[at(last.begin + last.count)] = static_cast<int>(nodes_.size());
    nodes_.push_back(nodes[at(last.begin + last.count)]);
  }
  for (const Chain& chain : chains_) {
    if (!chain.is_open) edges_.push_back(composed(chain));
  }
  for (std::size_t e = 0; e < all_.size(); ++e) {
    const Edge& edge = all_[e];
    if (edge.to == edge.from + 1 && steps_[at(edge.from)] == static_cast<int>(e)) continue;
    if (edge.shared != nullptr) return;
    edges_.push_back(edge);
  }
  for (Edge& edge : edges_) {
    edge.from = node_of[at(edge.from)];
    edge.to = node_of[at(edge.to)];
  }
  is_worthwhile_ = true;
}

// False where there is a keyframe that no step leads to, or few that only steps lead to.
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
  return static_cast<double>(chains_.size()) < kMostLeft * static_cast<double>(keyframes);
}

Edge ChainGraph::composed(const Chain& chain) const {
  if (chain.count == 1) return step(chain, 0);
  std::vector<Node> path(at(chain.count) + 1);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int t = 0; t < chain.count; ++t) {
    const Edge& z = step(chain, t);
    const Node& from = path[at(t)];
    path[at(t) + 1] = make_node(from.x + from.c * z.x - from.s * z.y,
                                from.y + from.s * z.x + from.c * z.y, from.theta + z.theta);
  }
  for (int t = 0; t < chain.count; ++t) {
    sum += lever_of(path[at(t)], path[at(t) + 1], path.back())
               .moved(covariances_[at(chain.begin + t)]);
  }
  const Eigen::Matrix3d W = symmetric_inverse(sum);
  Edge edge;
  edge.from = chain.begin;
  edge.to = chain.begin + chain.count;
  edge.x = path.back().x;
  edge.y = path.back().y;
  edge.theta = path.back().theta;
  edge.W = {W(0, 0), W(0, 1), W(0, 2), W(1, 1), W(1, 2), W(2, 2)};
  return edge;
}

void ChainGraph::compose(const Chain& chain, std::span<const Eigen::Vector3d> errors,
                         std::vector<Node>& all) const {
  for (int t = 0; t < chain.count; ++t) {
    const Edge& z = step(chain, t);
    const Node& from = all[at(chain.begin + t)];
    const double x = z.x + errors[at(t)].x();
    const double y = z.y + errors[at(t)].y();
    all[at(chain.begin + t) + 1] =
        make_node(from.x + from.c * x - from.s * y, from.y + from.s * x + from.c * y,
                  from.theta + z.theta + errors[at(t)].z());
  }
}

// ν of the steps: minimise Σ νᵀ W ν so that they end at `end`. With the levers A at the present
// path, ν = C Aᵀ λ, and λ makes Σ A ν what the end lacks of the path that is measured.
void ChainGraph::expand(const Chain& chain, const Node& end, std::vector<Node>& all) const {
  std::vector<Eigen::Vector3d> errors(at(chain.count), Eigen::Vector3d::Zero());
  std::vector<StepLever> levers(at(chain.count));
  compose(chain, errors, all);
  for (int pass = 0; pass < kPasses; ++pass) {
    const Node& last = all[at(chain.begin + chain.count)];
    Eigen::Vector3d lacks(end.x - last.x, end.y - last.y, wrap_angle(end.theta - last.theta));
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int t = 0; t < chain.count; ++t) {
      const std::size_t k = at(chain.begin + t);
      levers[at(t)] = lever_of(all[k], all[k + 1], last);
      sum += levers[at(t)].moved(covariances_[k]);
      lacks += levers[at(t)].along(errors[at(t)]);
    }
    const Eigen::Vector3d force = symmetric_inverse(sum) * lacks;
    for (int t = 0; t < chain.count; ++t) {
      errors[at(t)] = covariances_[at(chain.begin + t)] * levers[at(t)].back(force);
    }
    compose(chain, errors, all);
  }
}

std::vector<Node> ChainGraph::expanded(std::span<const Node> nodes) const {
  std::vector<Node> all(keyframes_);
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const Chain& chain = chains_[i];
    all[at(chain.begin)] = nodes[i];
    if (chain.is_open) {
      compose(chain, std::vector<Eigen::Vector3d>(at(chain.count), Eigen::Vector3d::Zero()), all);
      continue;
    }
    const Node& end = nodes[i + 1];
    if (chain.count > 1) expand(chain, end, all);
    all[at(chain.begin + chain.count)] = end;
  }
  return all;
}

}  // namespace fathom::pose_graph
