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
  if (!progress.is_fresh) return linearise_afresh(progress);
  solve_whole(progress);
}

void Smoother::linearise_afresh(Progress& progress) {
  progress.is_fresh = true;
  progress.is_whole = true;
  marks_.to_relinearise.clear();
  for (int k = 1; k < problem_.size(); ++k) marks_.to_relinearise.push_back(k);
  for_each_state([&](int v) { marks_.to_relinearise.push_back(v); });
}

void Smoother::solve_whole(Progress& progress) {
  slack_ = 0.0;
  const SmootherResult solved = solve_batch();
  progress.result.iterations += solved.iterations;
  end(progress, solved.outcome);
}

SmootherResult Smoother::solve_batch() {
  ++counts_.batch_solves;
  pose_graph::ExtendedGraph graph = extended(problem().edges);
  const SmootherResult solved = minimise_whole(graph);
  if (is_done(solved.outcome)) {
    for (int k = 1; k < problem_.size(); ++k) problem_.save(k, problem_.nodes[at(k)]);
    for_each_state([&](int v) { problem_.save(v, problem_.node(v)); });
    problem_.nodes.assign(graph.nodes.begin(), graph.nodes.begin() + problem_.size());
    problem_.pictures.keep(graph);
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
