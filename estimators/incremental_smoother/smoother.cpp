#include "estimators/incremental_smoother/smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/support/pose_graph/information.hpp"
#include "fathom/estimation/loop_rows.hpp"

namespace fathom::incremental_smoother {
Smoother::Smoother(const Pose& origin, const SmootherLimits& limits, const RobustLoss& loss)
    : limits_(limits),
      problem_(make_node(origin.x, origin.y, origin.theta), loss),
      tree_(problem_, limits.most_kept_bytes),
      gradient_(problem_),
      ignored_(1),
      changed_in_(1, -1) {}

Pose Smoother::pose(std::size_t k) {
  tree_.settle(static_cast<int>(k));
  const Node& node = problem_.nodes[k];
  return {node.x, node.y, wrap_angle(node.theta)};
}

MovedPoses Smoother::moved_since(std::uint64_t revision) const {
  if (revision < moved_in_) return {revision_, std::nullopt};
  return {revision_, consecutive(size() - (revision_ - revision), size())};
}

const Problem& Smoother::problem() {
  tree_.settle();
  return problem_;
}

void Smoother::add_keyframe(const RelativePose& step) {
  const RelativePose forward = step.forward();
  const Pose next = compose(pose(problem_.nodes.size() - 1), forward.motion);
  outside_steps_.push_back({forward.motion, forward.covariance()});
  problem_.add_node(make_node(next.x, next.y, next.theta));
  ++revision_;
  gradient_.add_keyframe();
  ignored_.emplace_back();
  changed_in_.push_back(-1);
  append_edge(step, false);
}

void Smoother::append_edge(const RelativePose& measurement, bool is_loop) {
  const bool is_robust = is_loop && problem_.loops.is_on();
  const int rank = is_robust ? rank_of(measurement.information) : 3;
  problem_.add_edge(pose_graph::make_edge(measurement), is_loop, rank);
  spread_.add(measurement);
  edge_pass_.push_back(-1);
  gradient_.add_edge();
}

// What is left of the gradient then is ignored.
void Smoother::evaluate_all() {
  tree_.settle();
  gradient_.evaluate_all();
  ignored_ = gradient_.by_keyframe();
}

void Smoother::note_changed(int k) {
  if (k == 0 || changed_in_[at(k)] == update_) return;
  changed_in_[at(k)] = update_;
  changed_.push_back(k);
}

SmootherResult Smoother::add_registrations(std::span<const RelativePose> registrations) {
  ++update_;
  problem_.begin_update();
  tree_.begin_update();
  touched_.clear();
  changed_.clear();
  const int edges_before = problem_.edge_count();
  for (const RelativePose& z : registrations) {
    for (const auto end : {z.from, z.to}) tree_.settle(static_cast<int>(end));
    append_edge(z, true);
    for (const auto end : {z.from, z.to}) {
      if (end == 0) continue;
      touched_.push_back(static_cast<int>(end));
      note_changed(static_cast<int>(end));
    }
  }
  SmootherResult result{Outcome::numerical_failure, 0};
  if (std::isfinite(gradient_.cost()) && refactor()) {
    result = iterate();
    if (!relinearise() || !is_determined()) result.outcome = Outcome::numerical_failure;
  }
  if (!is_done(result.outcome)) undo(edges_before);
  moved_in_ = ++revision_;
  return result;
}

// With what was touched comes what is new.
bool Smoother::refactor() {
  for (int k = std::max(1, first_outside_ - 1); k < problem_.size(); ++k) touched_.push_back(k);
  if (!tree_.refactor(touched_, problem_.size() - 1)) return false;
  counts_.eliminated += tree_.refactored();
  first_outside_ = problem_.size();
  outside_steps_.clear();
  return true;
}

// Linearises again where the estimate has left its linearisation.
bool Smoother::relinearise() {
  if (to_relinearise_.empty()) return true;
  if (!tree_.relinearise(to_relinearise_)) return false;
  counts_.eliminated += tree_.refactored();
  to_relinearise_.clear();
  return true;
}

// Measurements that are alike in their information always are.
bool Smoother::is_determined() {
  return !spread_.is_wide() || pose_graph::is_determined(weighted_edges(), problem_.nodes);
}

// Linearises everything at the estimate.
bool Smoother::rebuild() {
  tree_.clear();
  to_relinearise_.clear();
  touched_.clear();
  first_outside_ = 1;
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
    for (const int k : changed_) ignored_[at(k)] = gradient_.by_keyframe()[at(k)];
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
  const double promised = progress.is_whole
                              ? tree_.forward_all(gradient_.by_keyframe())
                              : tree_.forward(changed_, gradient_.by_keyframe(), ignored_);
  if (!std::isfinite(promised)) return end(progress, Outcome::numerical_failure);
  const double allowed = limits_.tolerance * gradient_.cost() + limits_.least_promise_chi2;
  if (progress.is_whole && promised <= (1.0 - progress.lost_curvature) * allowed) {
    return end(progress, Outcome::converged);
  }
  const double before = gradient_.cost();
  tree_.propagate(negligible_bend());
  reevaluate_bent();
  // A sum that was large before has rounding of its own.
  if (gradient_.cost() < limits_.cancellation * before) {
    tree_.settle();
    gradient_.evaluate_all();
  }
  if (!(gradient_.cost() <= before + allowed + limits_.rounding_chi2)) return retreat(progress);
  progress.is_fresh = false;
  tree_.find_to_relinearise(limits_.relinearise_m, limits_.relinearise_rad, to_relinearise_);
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
  ++pass_;
  for (const int v : tree_.bent()) {
    note_changed(v);
    problem_.for_each_edge(v, [&](int e, int other) {
      if (edge_pass_[at(e)] == pass_) return;
      edge_pass_[at(e)] = pass_;
      tree_.settle(other);
      gradient_.evaluate(e);
      note_changed(other);
      if (problem_.loops.has_left_tree(e, limits_.reweight_share)) {
        for (const int end : {v, other}) {
          if (end != 0) to_relinearise_.push_back(end);
        }
      }
    });
  }
}

}  // namespace fathom::incremental_smoother
