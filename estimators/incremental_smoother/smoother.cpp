#include "estimators/incremental_smoother/smoother.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include "estimators/sparse_gauss_newton/normal_equations.hpp"
#include <cstdlib>

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
      ignored_(1),
      weights_(1),
      changed_in_(1, -1),
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
  ignored_.push_back({});
  changed_in_.push_back(-1);
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
  std::fill(ignored_.begin(), ignored_.end(), Vec3{});
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
      note_changed(static_cast<int>(end));
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
  static const double NEG = getenv("NEG") ? atof(getenv("NEG")) : 1e-6;
  static const bool DBG = getenv("DBG");
  SmootherResult result;
  result.outcome = Outcome::iteration_limit;
  bool whole = false;
  bool fresh = false;
  while (result.iterations < limits_.max_iterations) {
    ++result.iterations;
    ++counts_.solves;
    if (whole) {
      ++counts_.polishes;
      sources_.clear();
      for (int k = 1; k < problem_.size(); ++k) sources_.push_back(k);
      std::fill(ignored_.begin(), ignored_.end(), Vec3{});
      if (!stale_.empty()) {
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
    } else {
      sources_ = changed_;
    }
    const double promised = tree_.forward(sources_, gradient_, ignored_);
    if (!std::isfinite(promised)) {
      result.outcome = Outcome::numerical_failure;
      break;
    }
    if (DBG) fprintf(stderr, "u%ld it%d sources %zu promised %.3e cost %.6e ", counts_.updates, result.iterations, sources_.size(), promised, cost_);
    if (whole && (promised <= limits_.tolerance * cost_ || promised <= kNoise)) {
      if (DBG) fprintf(stderr, "END\n");
      result.outcome = Outcome::converged;
      break;
    }
    const double before = cost_;
    tree_.descend(weights_, NEG);
    save_moved();
    reevaluate_bent();
    if (DBG) fprintf(stderr, "moved %zu bent %zu after %.6e stale %zu mismatch %.3e debt %.3e\n", tree_.moved().size(), tree_.bent().size(), cost_, stale_.size(), promised - (before - cost_), debt_);
    if (!(cost_ <= before * (1.0 + limits_.tolerance) + kNegligible)) {
      move_back();
      if (!fresh) {
        fresh = true;
        whole = true;
        stale_.clear();
        for (int k = 1; k < problem_.size(); ++k) stale_.push_back(k);
        continue;
      }
      const int iterations = result.iterations;
      result = solve_batch();
      result.iterations += iterations;
      break;
    }
    fresh = false;
    debt_ += std::abs(promised - (before - cost_));
    if (debt_ <= limits_.tolerance * cost_ + kNoise) {
      result.outcome = Outcome::converged;
      break;
    }
    debt_ = 0.0;
    whole = true;
  }
  for (const int k : changed_) ignored_[at(k)] = gradient_[at(k)];
  return result;
}

void Smoother::save_moved() {
  for (const int v : tree_.moved()) {
    if (saved_in_[at(v)] == counts_.updates) continue;
    saved_in_[at(v)] = counts_.updates;
    update_saved_.push_back({v, tree_.before(v)});
  }
  for (const int i : tree_.bent_cliques()) note_stale(i);
  counts_.visited += static_cast<long>(tree_.bent().size());
}

void Smoother::note_stale(int clique) {
  static const double REM = getenv("REM") ? atof(getenv("REM")) : 0.01;
  const Clique& c = tree_.clique(clique);
  const int last = c.rows() - 1;
  const Node& o = problem_.nodes[at(c.variables[at(last)])];
  const double* was = c.headings_rad.data();
  bool stale = false;
  for (int j = 0; j < last; ++j) {
    const Node& v = problem_.nodes[at(c.variables[at(j)])];
    const double dx = v.x - o.x;
    const double dy = v.y - o.y;
    const double hx = o.c * dx + o.s * dy - was[3 * j];
    const double hy = -o.s * dx + o.c * dy - was[3 * j + 1];
    const double turn = v.theta - o.theta - was[3 * j + 2];
    stale = stale || std::abs(turn) > limits_.relinearise_rad || hx * hx + hy * hy > REM * REM;
  }
  if (stale) stale_.push_back(c.variables[0]);
}

void Smoother::move_back() {
  for (const int v : tree_.moved()) problem_.nodes[at(v)] = tree_.before(v);
  reevaluate_bent();
}

void Smoother::note_changed(int k) {
  if (k == 0 || changed_in_[at(k)] == counts_.updates) return;
  changed_in_[at(k)] = counts_.updates;
  changed_.push_back(k);
}

void Smoother::reevaluate_bent() {
  ++pass_;
  for (const int v : tree_.bent()) {
    note_changed(v);
    problem_.for_each_edge(v, [&](int e, int other) {
      if (edge_pass_[at(e)] == pass_) return;
      edge_pass_[at(e)] = pass_;
      evaluate(e);
      note_changed(other);
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
