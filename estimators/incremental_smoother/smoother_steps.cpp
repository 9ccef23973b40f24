// The steps of a Smoother's update.

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimators/incremental_smoother/smoother.hpp"

namespace fathom::incremental_smoother {

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
    ignored_ = gradient_.by_variable();
  } else {
    for (const int v : marks_.changed) ignored_[v] = gradient_.by_variable()[v];
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
  before_step_ = {problem().nodes, problem_.pictures.errors};
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
      progress.is_whole ? tree_.forward_all(gradient_.by_variable())
                        : tree_.forward(marks_.changed, gradient_.by_variable(), ignored_);
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
  if (progress.is_whole && !contracts(progress, promised)) linearise_afresh(progress);
  progress.is_whole = true;
}

// Whether whole steps lead to the end soon. With the errors of pictures among the unknowns what a
// registration says is stiffer, by as much as it shares: what the limits of relinearisation leave
// may then be too much for the softest modes.
bool Smoother::contracts(Progress& progress, double promised) const {
  const double before = progress.promised_whole;
  progress.promised_whole = promised;
  return problem_.pictures.is_empty() || !(promised > limits_.stale_contraction * before);
}

// A motion that keyframes share changes nothing of what lies between them.
void Smoother::reevaluate_bent() {
  ++marks_.pass;
  for (const int v : tree_.bent()) {
    note_changed(v);
    if (is_errors(v)) reevaluate_prior(keyframe_of(v));
    problem_.for_each_edge_of(v, [&](int e, int other) {
      if (marks_.edge_pass[at(e)] == marks_.pass) return;
      marks_.edge_pass[at(e)] = marks_.pass;
      tree_.settle(other);
      gradient_.evaluate(e);
      note_changed(other);
      const Edge& edge = problem_.edges[at(e)];
      Problem::for_each_errors(edge, [&](int n) { note_changed(n); });
      if (!problem_.loops.has_left_tree(e, limits_.reweight_share)) return;
      Problem::for_each_end(edge, [&](int end) {
        if (end != 0) marks_.to_relinearise.push_back(end);
      });
    });
  }
}

void Smoother::reevaluate_prior(int keyframe) {
  gradient_.evaluate_prior(keyframe);
  tree_.settle(keyframe);
  note_changed(keyframe);
}

}  // namespace fathom::incremental_smoother
