// What a Smoother does where a step or an update fails.

#include "estimators/incremental_smoother/smoother.hpp"

namespace fathom::incremental_smoother {

// Where a step made F rise: once more, with everything linearised here; else in batch. A local step
// is the first of its update.
void Smoother::retreat(Progress& progress) {
  if (progress.is_whole) {
    tree_.place(before_step_);
  } else {
    tree_.forget_update();
  }
  // From where F may have been anything, infinite too.
  gradient_.evaluate_all();
  if (!progress.is_fresh) {
    progress.is_fresh = true;
    progress.is_whole = true;
    marks_.to_relinearise.clear();
    for (int k = 1; k < problem_.size(); ++k) marks_.to_relinearise.push_back(k);
    return;
  }
  solve_whole(progress);
}

void Smoother::solve_whole(Progress& progress) {
  slack_ = 0.0;
  const SmootherResult solved = solve_batch();
  progress.result.iterations += solved.iterations;
  end(progress, solved.outcome);
}

SmootherResult Smoother::solve_batch() {
  ++counts_.batch_solves;
  std::vector<Node> nodes = problem().nodes;
  const SmootherResult solved = minimise_whole(nodes);
  if (is_done(solved.outcome)) {
    for (int k = 1; k < problem_.size(); ++k) problem_.save(k, problem_.nodes[at(k)]);
    problem_.nodes = std::move(nodes);
    evaluate_all();
    if (!rebuild()) return {Outcome::numerical_failure, solved.iterations};
  }
  return {solved.outcome, solved.iterations};
}

void Smoother::undo(int edges_before) {
  tree_.forget_update();
  problem_.forget_edges(edges_before);
  marks_.edge_pass.resize(at(edges_before));
  evaluate_all();
  rebuild();
}

}  // namespace fathom::incremental_smoother
