#pragma once

#include <span>
#include <vector>

#include "estimators/incremental_smoother/clique.hpp"
#include "estimators/incremental_smoother/elimination.hpp"
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
class CliqueTree {
 public:
  /// The problem must outlive it.
  explicit CliqueTree(const Problem& problem) : problem_(problem) {}

  bool contains(int keyframe) const {
    return keyframe < static_cast<int>(clique_of_.size()) && clique_of_[at(keyframe)] >= 0;
  }
  void clear();

  /// Eliminates again what depends on these keyframes, in an order of its own with `newest` last;
  /// those that are not in the tree enter it. False, and the tree is empty, where the matrix is not
  /// positive definite.
  bool refactor(std::span<const int> keyframes, int newest);
  /// The same in the old order: where no measurement is new.
  bool refresh(std::span<const int> cliques);

  /// step() = −H⁻¹ g, g being the gradient at the cliques of `sources` and their ancestors, zero
  /// elsewhere. Goes down the tree as far as a step exceeds `negligible` squared sigmas.
  void solve(std::span<const int> sources, const std::vector<Vec3>& gradient,
             const std::vector<Weight>& weights, double negligible);
  /// 3 numbers a keyframe, valid where visited.
  const std::vector<double>& step() const { return x_; }
  /// The cliques that the last solve went through, parents first.
  const std::vector<int>& visited() const { return visited_; }
  /// −gᵀ step of the last solve.
  double promised() const { return promised_; }

  const Clique& clique(int i) const { return cliques_[at(i)]; }
  int clique_of(int keyframe) const { return clique_of_[at(keyframe)]; }

  /// Work of the last refactor or refresh: keyframes eliminated.
  int refactored() const { return refactored_; }

 private:
  void mark_up(int clique);
  void sort_marked();
  void unmark();
  void find_affected(std::span<const int> keyframes);
  void describe_rest();
  void release_marked();
  void build(int newest);
  int new_clique();
  bool factor(std::span<const int> which);
  bool goes_down(const Clique& clique) const;

  const Problem& problem_;
  std::vector<Clique> cliques_;
  std::vector<int> free_;
  std::vector<int> clique_of_;  ///< by keyframe; −1: not in the tree
  std::vector<long> order_;     ///< by keyframe, when it was eliminated
  long next_order_ = 0;
  std::vector<int> roots_;

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
  std::vector<char> is_moved_;  ///< by keyframe: its step is not negligible
  std::vector<int> visited_;
  std::vector<int> stack_;
  double promised_ = 0.0;
};

}  // namespace fathom::incremental_smoother
