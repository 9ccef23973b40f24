// What a Smoother does where a step or an update fails, or may have ended in a wrong minimum.

#include "estimators/incremental_smoother/smoother.hpp"
#include "estimators/support/pose_graph/wide.hpp"

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
    place(graph);
    if (!rebuild()) return {Outcome::numerical_failure, solved.iterations};
  }
  return {solved.outcome, solved.iterations};
}

// From the estimate before the update, where the sums of the tree do not carry the measurements.
// There is no tree of them.
SmootherResult Smoother::solve_rows() {
  tree_.forget_update();
  pose_graph::ExtendedGraph graph = extended(problem().edges);
  const auto solved = pose_graph::solve_wide(graph.edges, graph.nodes, pose_graph::Start::given,
                                             {limits_.max_iterations, limits_.tolerance});
  if (is_done(solved.outcome)) {
    place(graph);
    drop_tree();
    outside_.steps.clear();
  }
  return {solved.outcome, solved.iterations};
}

// Takes a lower minimum, where there is one.
void Smoother::search_lower(SmootherResult& result) {
  ++counts_.batch_solves;
  pose_graph::ExtendedGraph graph = extended(problem().edges);
  const auto found = search_.run(graph.edges, graph.nodes, gradient_.cost(),
                                 {limits_.max_iterations, limits_.tolerance});
  if (!found) return;
  result.outcome = found->outcome;
  result.iterations += found->iterations;
  slack_ = 0.0;
  place(graph);
  if (!rebuild()) result.outcome = Outcome::numerical_failure;
}

void Smoother::place(const pose_graph::ExtendedGraph& solved) {
  for (int k = 1; k < problem_.size(); ++k) problem_.save(k, problem_.nodes[at(k)]);
  for_each_state([&](int v) { problem_.save(v, problem_.node(v)); });
  problem_.nodes.assign(solved.nodes.begin(), solved.nodes.begin() + problem_.size());
  problem_.pictures.keep(solved);
  evaluate_all();
}

void Smoother::undo(int edges_before) {
  tree_.forget_update();
  problem_.forget_edges(edges_before);
  marks_.edge_pass.resize(at(edges_before));
  evaluate_all();
  rebuild();
}

}  // namespace fathom::incremental_smoother
