#pragma once

#include <span>
#include <vector>

#include "estimators/incremental_smoother/clique.hpp"
#include "estimators/incremental_smoother/elimination.hpp"
#include "estimators/incremental_smoother/motion.hpp"
#include "estimators/incremental_smoother/problem.hpp"

namespace fathom::incremental_smoother {

/// What a number of the step counts, in squared sigmas: of a position, of a heading.
struct Weight {
  double position = 0.0;
  double heading = 0.0;
};

/// The Cholesky factor of the Gauss-Newton matrix as a tree of cliques (the Bayes tree of Kaess et
/// al. 2012), each linearised where it was factored last. A change at some keyframes concerns their
/// cliques and the ancestors of those; all others keep what they have said of their separators.
///
/// Keyframe 0, which is fixed, is a separator like others: then each clique says how its keyframes
/// lie to each other, and nothing of where they are in the world.
class CliqueTree {
 public:
  /// The problem must outlive it.
  explicit CliqueTree(Problem& problem) : problem_(problem) {}

  void clear();

  /// Eliminates again what depends on these keyframes, in an order of its own with `newest` last;
  /// those that are not in the tree enter it. False, and the tree is empty, where the matrix is not
  /// positive definite.
  bool refactor(std::span<const int> keyframes, int newest);
  /// The same in the old order: where no measurement is new.
  bool refresh(std::span<const int> cliques);

  /// Forward substitution of b, which must be zero but at the cliques of these keyframes and their
  /// ancestors. Returns bᵀ H⁻¹ b.
  double forward(std::span<const int> sources, const std::vector<Vec3>& gradient,
                 const std::vector<Vec3>& ignored);
  /// The step H⁻¹ b, taken from the root down: the keyframes of a clique follow one of their
  /// separators as if they were rigidly joined, and what is left of the separators' motion bends
  /// them. Where it bends by less than `negligible` squared sigmas, and no b is below, all that is
  /// below follows rigidly.
  void descend(const std::vector<Weight>& weights, double negligible);

  /// Of the last descend: the keyframes that moved, and how many of them, the first, not just
  /// rigidly with their separators.
  const std::vector<int>& moved() const { return moved_; }
  const std::vector<int>& bent() const { return bent_; }
  const Node& before(int keyframe) const { return before_[at(keyframe)]; }
  const std::vector<int>& bent_cliques() const { return bent_cliques_; }

  const Clique& clique(int i) const { return cliques_[at(i)]; }
  int clique_of(int keyframe) const { return clique_of_[at(keyframe)]; }
  /// Work of the last refactor or refresh: keyframes eliminated.
  int refactored() const { return refactored_; }

 private:
  void grow();
  void mark_up(int clique);
  void sort_marked();
  void unmark();
  void find_affected(std::span<const int> keyframes);
  void describe_rest();
  void release_marked();
  void build(int newest);
  void attach(int clique);
  int new_clique();
  bool factor(std::span<const int> which);
  void bend(int clique, const std::vector<Weight>& weights, double negligible);
  void follow(int clique, const RigidMotion& rigid);

  Problem& problem_;
  std::vector<Clique> cliques_;
  std::vector<int> free_;
  std::vector<int> clique_of_;  ///< by keyframe; −1: not in the tree
  std::vector<long> order_;     ///< by keyframe, when it was eliminated
  long next_order_ = 0;
  int root_ = -1;

  std::vector<int> marked_;
  std::vector<int> affected_;
  std::vector<int> orphans_;
  std::vector<int> index_of_;  ///< by keyframe, in affected_; −1
  RestGraph rest_;
  MinimumDegree minimum_degree_;
  Elimination elimination_;
  std::vector<int> built_;
  int refactored_ = 0;

  std::vector<int> row_of_;
  std::vector<double> packed_;
  std::vector<double> signs_;
  std::vector<double> gathered_;
  std::vector<double> x_;
  std::vector<Node> before_;
  std::vector<int> moved_;
  std::vector<int> bent_;
  std::vector<int> bent_cliques_;
  std::vector<int> stack_;
};

}  // namespace fathom::incremental_smoother
