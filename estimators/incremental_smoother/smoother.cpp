#include "estimators/incremental_smoother/smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/support/pose_graph/bridge.hpp"
#include "estimators/support/pose_graph/information.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::incremental_smoother {
Smoother::Smoother(const Pose& origin, const SmootherLimits& limits, const RobustLoss& loss)
    : limits_(limits),
      problem_(make_node(origin.x, origin.y, origin.theta), loss),
      tree_(problem_, limits.most_kept_bytes),
      gradient_(problem_),
      ignored_(1) {
  marks_.changed_in.push_back(-1);
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
  ignored_.emplace_back();
  marks_.changed_in.push_back(-1);
  append_edge(step, false);
}

void Smoother::append_edge(const RelativePose& measurement, bool is_loop) {
  const bool is_robust = is_loop && problem_.loops.is_on();
  const int rank = is_robust ? rank_of(measurement.information) : 3;
  problem_.add_edge(pose_graph::make_edge(measurement), is_loop, rank);
  spread_.add(measurement);
  marks_.edge_pass.push_back(-1);
  gradient_.add_edge();
}

// What is left of the gradient then is ignored.
void Smoother::evaluate_all() {
  tree_.settle();
  gradient_.evaluate_all();
  ignored_ = gradient_.by_keyframe();
}

void Smoother::note_changed(int k) {
  if (k == 0 || marks_.changed_in[at(k)] == marks_.update) return;
  marks_.changed_in[at(k)] = marks_.update;
  marks_.changed.push_back(k);
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
  add_loops(registrations);
  SmootherResult result{Outcome::numerical_failure, 0};
  // 2. The top of the tree that has these, eliminated again, with the keyframes that are new.
  if (std::isfinite(gradient_.cost()) && refactor()) {
    // 3. Steps: each solves the tree for what has changed, is taken where F falls, and marks the
    //    variables that have left their linearisation point.
    result = iterate();
    // 4. Those are linearised again; a matrix that leaves a pose open is a failure.
    if (!relinearise() || !is_determined()) result.outcome = Outcome::numerical_failure;
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
    append_edge(z, true);
    for (const auto end : {z.from, z.to}) {
      if (end == 0) continue;
      marks_.touched.push_back(static_cast<int>(end));
      note_changed(static_cast<int>(end));
    }
  }
}

// With what was touched comes what is new.
bool Smoother::refactor() {
  for (int k = std::max(1, outside_.first - 1); k < problem_.size(); ++k)
    marks_.touched.push_back(k);
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
bool Smoother::is_determined() {
  return !spread_.is_wide() || pose_graph::is_determined(weighted_edges(), problem_.nodes);
}

// Linearises everything at the estimate.
bool Smoother::rebuild() {
  tree_.clear();
  marks_.to_relinearise.clear();
  marks_.touched.clear();
  outside_.first = 1;
  return problem_.size() < 2 || refactor();
}

void Smoother::end(Progress& progress, Outcome outcome) {
  progress.is_over = true;
  progress.result.outcome = outcome;
}

SmootherResult Smoother::iterate() {
  Progress progress;
  progress.result.outcome = Outcome::iteration_limit;
  progress.is_whole = !std::isfinite(slack_);
  while (!progress.is_over && progress.result.iterations < limits_.max_iterations) {
    ++progress.result.iterations;
    if (prepare_step(progress)) {
      take_step(progress);
    } else {
      end(progress, Outcome::numerical_failure);
    }
  }
  // The next update begins where this one was stopped.
  if (!progress.is_over) slack_ = std::numeric_limits<double>::infinity();
  if (progress.is_whole) {
    ignored_ = gradient_.by_keyframe();
  } else {
    for (const int k : marks_.changed) ignored_[at(k)] = gradient_.by_keyframe()[at(k)];
  }
  return progress.result;
}

// A step of the whole gradient wants a tree that is linearised where it matters, and so does a
// further one of what the update has changed.
bool Smoother::prepare_step(const Progress& progress) {
  ++counts_.steps;
  if (!progress.is_whole) return relinearise();
  ++counts_.whole_steps;
  slack_ = 0.0;
  before_step_ = problem().nodes;
  return relinearise();
}

// In squared sigmas.
double Smoother::negligible_bend() const {
  const double mean_cost = gradient_.cost() / static_cast<double>(problem_.size());
  return limits_.tolerance *
         std::max(limits_.bend_share, limits_.bend_share_of_mean_cost * mean_cost);
}

void Smoother::take_step(Progress& progress) {
  const CliqueTree::Step step =
      progress.is_whole ? tree_.forward_all(gradient_.by_keyframe())
                        : tree_.forward(marks_.changed, gradient_.by_keyframe(), ignored_);
  const double promised = step.promised();
  if (!std::isfinite(promised)) return end(progress, Outcome::numerical_failure);
  const double allowed = limits_.tolerance * gradient_.cost() + limits_.least_promise_chi2;
  if (progress.is_whole && promised <= (1.0 - progress.lost_curvature) * allowed) {
    return end(progress, Outcome::converged);
  }
  const double before = gradient_.cost();
  tree_.propagate(step, negligible_bend());
  reevaluate_bent();
  // A sum that was large before has rounding of its own.
  if (gradient_.cost() < limits_.cancellation * before) {
    tree_.settle();
    gradient_.evaluate_all();
  }
  if (!(gradient_.cost() <= before + allowed + limits_.rounding_chi2)) return retreat(progress);
  progress.is_fresh = false;
  tree_.find_to_relinearise(limits_.relinearise_m, limits_.relinearise_rad, marks_.to_relinearise);
  const double left = left_by_step(progress, promised, before - gradient_.cost());
  const double most_slack = limits_.tolerance * gradient_.cost() + limits_.least_promise_chi2;
  if (goes_on_locally(progress, left, most_slack)) return;
  slack_ += left;
  if (slack_ <= most_slack) return end(progress, Outcome::converged);
  if (wants_newton(progress)) return solve_whole(progress);
  progress.is_whole = true;
}

// A motion that keyframes share changes nothing of what lies between them.
void Smoother::reevaluate_bent() {
  ++marks_.pass;
  for (const int v : tree_.bent()) {
    note_changed(v);
    problem_.for_each_edge(v, [&](int e, int other) {
      if (marks_.edge_pass[at(e)] == marks_.pass) return;
      marks_.edge_pass[at(e)] = marks_.pass;
      tree_.settle(other);
      gradient_.evaluate(e);
      note_changed(other);
      if (problem_.loops.has_left_tree(e, limits_.reweight_share)) {
        for (const int end : {v, other}) {
          if (end != 0) marks_.to_relinearise.push_back(end);
        }
      }
    });
  }
}

}  // namespace fathom::incremental_smoother
