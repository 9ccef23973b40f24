#pragma once

#include <span>
#include <vector>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom::incremental_smoother {

struct SmootherLimits {
  int max_iterations = 100;
  double tolerance = 1e-6;
  double relinearise_rad = 0.05;
};

struct SmootherResult {
  Outcome outcome = Outcome::converged;
  int iterations = 0;
};

/// What the updates did so far.
struct Counts {
  long updates = 0;
  long solves = 0;
  long refactored = 0;  ///< keyframes, over all updates
  long visited = 0;     ///< keyframes moved, over all solves
  long refreshed = 0;   ///< keyframes factored again in their old order
  long refreshes = 0;
  long polishes = 0;
  long batches = 0;     ///< updates that fell back to a solve of the whole graph
};

/// The estimate of a growing pose graph, kept at its optimum.
class Smoother {
 public:
  Smoother(const Pose& origin, const SmootherLimits& limits);

  const Problem& problem() const { return problem_; }
  Pose pose(std::size_t k) const;

  /// A keyframe at the newest one ⊕ the step. It enters the factor with the next registrations.
  void add_keyframe(const RelativePose& step);
  /// Minimises F with these registrations added; as it was before where that fails.
  SmootherResult add_registrations(std::span<const RelativePose> registrations);

  const Counts& counts() const { return counts_; }
  int refactored_last() const { return tree_.refactored(); }

 private:
  void append_edge(const RelativePose& measurement);
  void evaluate(int edge);
  SmootherResult iterate();
  void save_moved();
  void move_back();
  void note_changed(int keyframe);
  void reevaluate_bent();
  void note_stale(int clique);
  SmootherResult solve_batch();
  void evaluate_all();
  void undo(int edges_before);

  SmootherLimits limits_;
  Problem problem_;
  CliqueTree tree_;
  std::vector<EdgeGradient> terms_;  ///< by edge
  std::vector<Vec3> gradient_;       ///< of ½F, by keyframe, its own axes
  std::vector<Vec3> ignored_;        ///< what earlier updates left of it
  std::vector<Weight> weights_;
  double cost_ = 0.0;
  double debt_ = 0.0;  ///< by how much F may exceed its optimum

  int first_outside_ = 1;  ///< the first keyframe that is not in the tree
  std::vector<int> stale_;  ///< keyframes whose clique bent since it was factored
  std::vector<int> touched_;
  std::vector<int> sources_;
  std::vector<int> changed_;  ///< keyframes whose gradient changed
  std::vector<long> edge_pass_;
  std::vector<long> changed_in_;
  long pass_ = 0;

  struct Saved {
    int keyframe;
    Node node;
  };
  std::vector<Saved> update_saved_;  ///< before the update
  std::vector<long> saved_in_;       ///< the update in which a keyframe was saved
  Counts counts_;
};

}  // namespace fathom::incremental_smoother
