#include "estimators/incremental_smoother/smoother.hpp"

#include <algorithm>
#include <cmath>

#include "estimators/sparse_gauss_newton/batch.hpp"

namespace fathom::incremental_smoother {
namespace {

// By so much, as a share, rounding may make F rise.
constexpr double kRounding = 1e-11;
// Differences of F that mean nothing, in squared sigmas.
constexpr double kNegligible = 1e-12;
constexpr double kNoise = 1e-20;

Weight& operator+=(Weight& a, const Weight& b) {
  a.position += b.position;
  a.heading += b.heading;
  return a;
}

}  // namespace

Smoother::Smoother(const Pose& origin, const SmootherLimits& limits)
    : limits_(limits),
      problem_(make_node(origin.x, origin.y, origin.theta)),
      tree_(problem_),
      gradient_(1),
      weights_(1),
      keyframe_pass_(1, -1),
      saved_in_(1, -1) {}

Pose Smoother::pose(std::size_t k) const {
  const Node& node = problem_.nodes[k];
  return {node.x, node.y, wrap_angle(node.theta)};
}

void Smoother::add_keyframe(const RelativePose& step) {
  const Pose next = compose(pose(problem_.nodes.size() - 1), step.forward().motion);
  problem_.add_node(make_node(next.x, next.y, next.theta));
  gradient_.push_back({});
  weights_.push_back({});
  keyframe_pass_.push_back(-1);
  saved_in_.push_back(-1);
  append_edge(step);
}

void Smoother::append_edge(const RelativePose& measurement) {
  const Edge edge = sparse_gauss_newton::make_edge(measurement);
  problem_.add_edge(edge);
  terms_.emplace_back();
  edge_pass_.push_back(-1);
  evaluate(problem_.edge_count() - 1);
  const double position = 0.5 * (edge.W[0] + edge.W[3]);
  const double lever = edge.x * edge.x + edge.y * edge.y;
  weights_[at(edge.to)] += Weight{position, edge.W[5]};
  weights_[at(edge.from)] += Weight{position, edge.W[5] + lever * position};
}

void Smoother::evaluate(int e) {
  const Edge& edge = problem_.edges[at(e)];
  EdgeGradient& t = terms_[at(e)];
  const EdgeGradient next = gradient_of(edge, problem_.nodes[at(edge.from)],
                                        problem_.nodes[at(edge.to)]);
  Vec3& from = gradient_[at(edge.from)];
  Vec3& to = gradient_[at(edge.to)];
  for (std::size_t a = 0; a < 3; ++a) {
    from[a] += next.from[a] - t.from[a];
    to[a] += next.to[a] - t.to[a];
  }
  cost_ += next.cost - t.cost;
  t = next;
}

void Smoother::evaluate_all() {
  cost_ = 0.0;
  std::fill(gradient_.begin(), gradient_.end(), Vec3{});
  std::fill(terms_.begin(), terms_.end(), EdgeGradient{});
  for (int e = 0; e < problem_.edge_count(); ++e) evaluate(e);
}

SmootherResult Smoother::add_registrations(std::span<const RelativePose> registrations) {
  ++counts_.updates;
  const int edges_before = problem_.edge_count();
  update_saved_.clear();
  touched_.clear();
  changed_.clear();
  for (int k = first_outside_; k < problem_.size(); ++k) touched_.push_back(k);
  if (first_outside_ > 1) touched_.push_back(first_outside_ - 1);
  for (const RelativePose& z : registrations) {
    append_edge(z);
    for (const auto end : {z.from, z.to}) {
      if (end == 0) continue;
      touched_.push_back(static_cast<int>(end));
      changed_.push_back(static_cast<int>(end));
    }
  }
  for (const int v : stale_) touched_.push_back(v);
  stale_.clear();
  SmootherResult result;
  result.outcome = Outcome::numerical_failure;
  if (std::isfinite(cost_) && tree_.refactor(touched_, problem_.size() - 1)) {
    counts_.refactored += tree_.refactored();
    first_outside_ = problem_.size();
    result = iterate();
  }
  if (!is_done(result.outcome)) undo(edges_before);
  return result;
}

SmootherResult Smoother::iterate() {
  SmootherResult result;
  result.outcome = Outcome::iteration_limit;
  // Steps that are left out must not add up to what a step that counts is.
  const double negligible = 1e-2 * limits_.tolerance;
  double last = -1.0;
  while (result.iterations < limits_.max_iterations) {
    find_sources();
    if (sources_.empty()) {
      result.outcome = Outcome::converged;
      break;
    }
    ++result.iterations;
    ++counts_.solves;
    tree_.solve(sources_, gradient_, weights_, negligible);
    const double promised = tree_.promised();
    if (!std::isfinite(promised)) {
      result.outcome = Outcome::numerical_failure;
      break;
    }
    const double before = cost_;
    move();
    reevaluate_moved();
    if (!(cost_ <= before * (1.0 + kRounding) + kNegligible)) {
      move_back();
      const int iterations = result.iterations;
      result = solve_batch();
      result.iterations += iterations;
      break;
    }
    if (promised <= limits_.tolerance * cost_ || promised <= kNoise) {
      result.outcome = Outcome::converged;
      break;
    }
    if (last >= 0.0 && promised > 0.1 * last && !stale_.empty()) {
      touched_.clear();
      for (const int v : stale_) touched_.push_back(tree_.clique_of(v));
      stale_.clear();
      ++counts_.refreshes;
      if (!tree_.refresh(touched_)) {
        result.outcome = Outcome::numerical_failure;
        break;
      }
      counts_.refreshed += tree_.refactored();
    }
    last = promised;
  }
  return result;
}

bool Smoother::is_source(int k) const {
  const Vec3& g = gradient_[at(k)];
  const Weight& w = weights_[at(k)];
  const double share = (g[0] * g[0] + g[1] * g[1]) * w.heading + g[2] * g[2] * w.position;
  return share > 1e-4 * limits_.tolerance * w.position * w.heading;
}

void Smoother::find_sources() {
  sources_.clear();
  for (const int k : changed_) {
    if (is_source(k)) sources_.push_back(k);
  }
}

void Smoother::move() {
  step_saved_.clear();
  const std::vector<double>& step = tree_.step();
  for (const int i : tree_.visited()) {
    const Clique& c = tree_.clique(i);
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      Node& node = problem_.nodes[at(v)];
      step_saved_.push_back({v, node});
      if (saved_in_[at(v)] != counts_.updates) {
        saved_in_[at(v)] = counts_.updates;
        update_saved_.push_back({v, node});
      }
      const double* d = step.data() + 3 * v;
      node = make_node(node.x + node.c * d[0] - node.s * d[1],
                       node.y + node.s * d[0] + node.c * d[1], node.theta + d[2]);
    }
    note_stale(i);
  }
  counts_.visited += static_cast<long>(step_saved_.size());
}

void Smoother::note_stale(int clique) {
  const Clique& c = tree_.clique(clique);
  double least = 1e9;
  double most = -1e9;
  for (int j = 0; j < c.rows(); ++j) {
    const double turn = problem_.nodes[at(c.variables[at(j)])].theta - c.headings_rad[at(j)];
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  if (most - least > limits_.relinearise_rad) stale_.push_back(c.variables[0]);
}

void Smoother::move_back() {
  for (const Saved& saved : step_saved_) problem_.nodes[at(saved.keyframe)] = saved.node;
  reevaluate_moved();
}

void Smoother::reevaluate_moved() {
  ++pass_;
  changed_.clear();
  const auto change = [&](int k) {
    if (k == 0 || keyframe_pass_[at(k)] == pass_) return;
    keyframe_pass_[at(k)] = pass_;
    changed_.push_back(k);
  };
  for (const Saved& saved : step_saved_) {
    change(saved.keyframe);
    problem_.for_each_edge(saved.keyframe, [&](int e, int other) {
      if (edge_pass_[at(e)] == pass_) return;
      edge_pass_[at(e)] = pass_;
      evaluate(e);
      change(other);
    });
  }
}

SmootherResult Smoother::solve_batch() {
  ++counts_.batches;
  std::vector<Node> nodes = problem_.nodes;
  const auto solved = sparse_gauss_newton::solve_batch(
      problem_.edges, nodes, sparse_gauss_newton::Start::given,
      {limits_.max_iterations, limits_.tolerance});
  if (is_done(solved.outcome)) {
    for (int k = 1; k < problem_.size(); ++k) {
      if (saved_in_[at(k)] != counts_.updates) update_saved_.push_back({k, problem_.nodes[at(k)]});
    }
    problem_.nodes = std::move(nodes);
    evaluate_all();
    tree_.clear();
    stale_.clear();
    first_outside_ = 1;
  }
  return {solved.outcome, solved.iterations};
}

void Smoother::undo(int edges_before) {
  for (const Saved& saved : update_saved_) problem_.nodes[at(saved.keyframe)] = saved.node;
  while (problem_.edge_count() > edges_before) {
    problem_.remove_edge();
    terms_.pop_back();
    edge_pass_.pop_back();
  }
  evaluate_all();
  tree_.clear();
  stale_.clear();
  first_outside_ = 1;
}

}  // namespace fathom::incremental_smoother
