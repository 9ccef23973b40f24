#pragma once

#include <deque>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/incremental_smoother/clique.hpp"
#include "estimators/incremental_smoother/elimination.hpp"
#include "estimators/incremental_smoother/motion.hpp"
#include "estimators/incremental_smoother/problem.hpp"

namespace fathom::incremental_smoother {

/// The Cholesky factor of the Gauss-Newton matrix as a tree of cliques (the Bayes tree of Kaess et
/// al. 2012), each linearised where it was factored last. A change at some keyframes concerns their
/// cliques and the ancestors of those; all others keep what they have said of their separators.
///
/// Keyframe 0, which is fixed, is a separator like others: then each clique says how its keyframes
/// lie to each other, and nothing of where they are in the world.
class CliqueTree {
 public:
  /// The problem must outlive it. Schur complements beyond so many bytes may be dropped.
  CliqueTree(Problem& problem, std::size_t most_kept_bytes)
      : problem_(problem), most_kept_(most_kept_bytes / sizeof(double)) {}

  void clear();

  /// Eliminates again what depends on these keyframes, in an order of its own with `newest` last;
  /// those that are not in the tree enter it. False, and the tree is empty, where the matrix is not
  /// positive definite.
  bool refactor(std::span<const int> keyframes, int newest);
  /// The same in the old order: where no measurement is new.
  bool relinearise(std::span<const int> keyframes);
  /// How many keyframes the last of both has eliminated.
  int refactored() const { return refactored_; }

  /// y = L⁻¹ b for b = ignored − gradient, which must be zero but at these keyframes; the other
  /// form is for any b. Return yᵀ y = bᵀ H⁻¹ b.
  double forward(std::span<const int> keyframes, const std::vector<Vec3>& gradient,
                 const std::vector<Vec3>& ignored);
  double forward_all(const std::vector<Vec3>& gradient);

  /// Propagates the step H⁻¹ b from the root down: the keyframes of a clique follow one of their
  /// separators as if they were joined rigidly, and what is left of the separators' motion bends
  /// them. Where that is less than `negligible` squared sigmas, and b is zero below, all that is
  /// below follows rigidly, which is noted once at its top; or stays, if it would not move by more
  /// either. Nodes that are changed are saved.
  void propagate(double negligible);

  /// Of the last propagate: keyframes that moved and did not just follow.
  const std::vector<int>& bent() const { return bent_; }

  /// The node of a keyframe is up to date after this, until the next propagate; or those of all.
  void settle(int keyframe);
  void settle();

  /// Nobody follows what is noted and not yet passed on.
  void drop_motions();

  /// From here on forget_update takes back what cliques were to follow. Schur complements that
  /// are too many are dropped, those first that were not needed for longest.
  void begin_update();
  /// With Problem::restore_saved all keyframes are where they were when the update began.
  void forget_update();

  /// One keyframe of each clique that the last propagate has bent, and whose keyframes have turned
  /// by more than `limit_rad` to each other since it was factored, or moved by more than `limit_m`
  /// and `limit_rad` of their distance.
  void find_to_relinearise(double limit_m, double limit_rad, std::vector<int>& keyframes) const;

  /// J H⁻¹ Jᵀ of a quantity with these derivatives by two keyframes, each in its own axes.
  Eigen::Matrix3d variance(int i, const Eigen::Matrix3d& J_i, int k, const Eigen::Matrix3d& J_k);

 private:
  void grow();
  void mark_up(int keyframe);
  void mark_all();
  void sort_marked();
  void unmark();
  void find_affected(std::span<const int> keyframes);
  void form_quotient_graph();
  void release_marked();
  int older_than(int keyframe) const;
  void build(int first, int newest);
  int new_clique();
  void attach(int clique);
  bool factor(std::span<const int> which);
  bool factor_some(std::span<const int> which);
  void add_dropped(std::span<const int> which);
  void make_room(Clique& clique);
  void queue(int clique);
  void release_update(Clique& clique);
  template <class Use>
  void for_each_dropped_above(const Clique& clique, Use use) {
    for (int i = clique.parent; i >= 0 && cliques_[at(i)].kept == Kept::no;
         i = cliques_[at(i)].parent) {
      use(cliques_[at(i)]);
    }
  }
  void drop_update(Clique& clique);
  void drop_updates();
  void set_right_side(const std::vector<Vec3>& gradient, const std::vector<Vec3>* ignored);
  double substitute();
  bool bend_separator(const Clique& clique, const RigidMotion& rigid, double negligible);
  bool has_moved(const Clique& clique, double negligible) const;
  void bend(int clique, double negligible);
  void follow(int clique, const RigidMotion& rigid);
  void settle_clique(int clique);
  void settle_path(int clique);
  void note_before_update(int clique);

  Problem& problem_;
  std::vector<Clique> cliques_;
  std::vector<int> free_;
  BufferPool buffers_;
  std::vector<int> clique_of_;  ///< by keyframe; −1: not in the tree
  std::vector<long> order_;     ///< by keyframe, when it was eliminated
  long next_order_ = 0;
  int root_ = -1;

  std::vector<int> marked_;
  std::vector<int> affected_;  ///< keyframes to be eliminated, and keyframe 0
  std::vector<int> orphans_;   ///< children of cliques that are gone
  std::vector<int> index_of_;  ///< by keyframe, in affected_; −1
  QuotientGraph quotient_;
  MinimumDegree minimum_degree_;
  Elimination elimination_;
  std::vector<int> built_;
  std::vector<int> to_factor_;
  int refactored_ = 0;

  std::deque<int> queue_;  ///< cliques whose update may be dropped
  std::size_t most_kept_ = 0;
  std::size_t kept_ = 0;      ///< numbers in updates that may be
  bool has_dropped_ = false;  ///< whether any was

  // Workspace.
  std::vector<int> row_of_;
  std::vector<double> packed_;
  std::vector<double> signs_;
  std::vector<double> gathered_;
  std::vector<double> x_;  ///< b, then y, three numbers a keyframe
  std::vector<int> stack_;

  std::vector<Node> before_;  ///< the last propagate: where its bent keyframes were
  std::vector<int> bent_;
  std::vector<int> bent_cliques_;

  long update_ = 0;
  long step_ = 0;               ///< how often propagate was called
  bool has_followers_ = false;  ///< whether there may be cliques with a motion to follow
  std::vector<int> followers_;  ///< those that this update has told to
};

}  // namespace fathom::incremental_smoother
