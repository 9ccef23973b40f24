#include "estimators/incremental_smoother/smoother.hpp"

#include <algorithm>
#include <cmath>

#include "estimators/support/pose_graph/bridge.hpp"
#include "estimators/support/pose_graph/wide.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::incremental_smoother {
Smoother::Smoother(const Pose& origin, const SmootherLimits& limits, const RobustLoss& loss,
                   ErrorStates error_states)
    : limits_(limits),
      error_states_(error_states),
      problem_(make_node(origin.x, origin.y, origin.theta), loss,
               error_states == ErrorStates::of_several),
      tree_(problem_, limits.most_kept_bytes),
      gradient_(problem_),
      ignored_{std::vector<Vec3>(1)} {
  marks_.changed_in.poses.push_back(-1);
}

Pose Smoother::pose(std::size_t k) {
  tree_.settle(static_cast<int>(k));
  const Node& node = problem_.nodes[k];
  return {node.x, node.y, wrap_angle(node.theta)};
}

MovedPoses Smoother::moved_since(std::uint64_t revision) const {
  if (revision < revisions_.moved_in) return {revisions_.now, std::nullopt};
  return {revisions_.now, consecutive(size() - (revisions_.now - revision), size())};
}

const Problem& Smoother::problem() {
  tree_.settle();
  return problem_;
}

void Smoother::add_keyframe(const RelativePose& step) {
  const RelativePose forward = step.forward();
  const Pose next = compose(pose(problem_.nodes.size() - 1), forward.motion);
  outside_.steps.push_back({forward.motion, forward.covariance()});
  problem_.add_node(make_node(next.x, next.y, next.theta));
  ++revisions_.now;
  gradient_.add_keyframe();
  ignored_.poses.emplace_back();
  marks_.changed_in.poses.push_back(-1);
  append_edge(step, false);
}

void Smoother::append_edge(const RelativePose& measurement, bool is_loop) {
  const bool is_robust = is_loop && problem_.loops.is_on();
  const int rank = is_robust ? rank_of(measurement.information) : 3;
  const bool shares = is_loop && has_states(measurement);
  problem_.add_edge(wide_rows_.make_edge(measurement), is_loop, rank,
                    shares ? measurement.shared.get() : nullptr);
  grow_errors();
  spread_.add(measurement);
  marks_.edge_pass.push_back(-1);
  gradient_.add_edge();
}

// What is left of the gradient then is ignored.
void Smoother::evaluate_all() {
  tree_.settle();
  gradient_.evaluate_all();
  ignored_ = gradient_.by_variable();
}

void Smoother::note_changed(int v) {
  if (v == 0 || marks_.changed_in[v] == marks_.update) return;
  marks_.changed_in[v] = marks_.update;
  marks_.changed.push_back(v);
}

// All that follows moves, which happens once a hole: the tree is made anew.
void Smoother::bridge(const Bridge& bridge) {
  tree_.settle();
  pose_graph::bridge(bridge, problem_.edges, problem_.nodes);
  evaluate_all();
  rebuild();
  revisions_.moved_in = ++revisions_.now;
}

// As ISAM2's update (Kaess et al. 2012), but that steps are taken until F is at its minimum.
SmootherResult Smoother::add_registrations(std::span<const RelativePose> registrations) {
  // 1. New factors, and the variables that they touch.
  const int edges_before = problem_.edge_count();
  const double cost_before = gradient_.cost();
  add_loops(registrations);
  SmootherResult result{Outcome::numerical_failure, 0};
  // 2. The top of the tree that has these, eliminated again, with the keyframes that are new.
  if (std::isfinite(gradient_.cost()) && refactor()) {
    // 3. Steps: each solves the tree for what has changed, is taken where F falls, and marks the
    //    variables that have left their linearisation point.
    result = iterate();
    // A redescending loss has minima that no start for least squares leads to.
    if (is_done(result.outcome) && !problem_.loops.is_on() &&
        search_.is_due(cost_before, gradient_.cost(), registrations.size())) {
      search_lower(result);
    }
    // 4. Those are linearised again; a matrix that leaves a pose open is a failure.
    if (!relinearise() || !keeps_digits()) result.outcome = Outcome::numerical_failure;
  }
  if (!is_done(result.outcome) && spread_.is_wide() && !problem_.loops.is_on()) {
    result = solve_rows();
  }
  // 5. Where any of these failed, the estimate is that of before.
  if (!is_done(result.outcome)) undo(edges_before);
  revisions_.moved_in = ++revisions_.now;
  return result;
}

void Smoother::add_loops(std::span<const RelativePose> registrations) {
  ++marks_.update;
  tree_.begin_update();
  marks_.touched.clear();
  marks_.changed.clear();
  for (const RelativePose& z : registrations) {
    for (const auto end : {z.from, z.to}) tree_.settle(static_cast<int>(end));
    if (has_states(z)) {
      for (const auto end : {z.from, z.to}) unfold(static_cast<int>(end));
    }
    append_edge(z, true);
    touch_ends(problem_.edges.back());
  }
}

void Smoother::touch_ends(const Edge& edge) {
  Problem::for_each_end(edge, [&](int v) {
    if (v == 0) return;
    marks_.touched.push_back(v);
    note_changed(v);
  });
}

// With what was touched comes what is new.
bool Smoother::refactor() {
  for (int k = std::max(1, outside_.first - 1); k < problem_.size(); ++k)
    marks_.touched.push_back(k);
  if (outside_.first == 1) for_each_state([&](int v) { marks_.touched.push_back(v); });
  if (!tree_.refactor(marks_.touched, problem_.size() - 1)) return false;
  counts_.eliminated += tree_.refactored();
  outside_.first = problem_.size();
  outside_.steps.clear();
  return true;
}

// Linearises again where the estimate has left its linearisation.
bool Smoother::relinearise() {
  if (marks_.to_relinearise.empty()) return true;
  if (!tree_.relinearise(marks_.to_relinearise)) return false;
  counts_.eliminated += tree_.refactored();
  marks_.to_relinearise.clear();
  return true;
}

// Measurements that are alike in their information always are.
bool Smoother::keeps_digits() {
  if (!spread_.is_wide()) return true;
  const pose_graph::ExtendedGraph graph = weighted_graph();
  return pose_graph::sums_keep_digits(graph.edges, graph.nodes);
}

// The next update eliminates all.
void Smoother::drop_tree() {
  tree_.clear();
  marks_.to_relinearise.clear();
  marks_.touched.clear();
  outside_.first = 1;
}

// Linearises everything at the estimate.
bool Smoother::rebuild() {
  drop_tree();
  return problem_.size() < 2 || refactor();
}

}  // namespace fathom::incremental_smoother
