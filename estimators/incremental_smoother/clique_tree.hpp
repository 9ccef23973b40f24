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
  CliqueTree(Problem& problem, std::size_t most_kept_bytes) : problem_(problem) {
    updates_.most = most_kept_bytes / sizeof(double);
  }

  void clear();

  /// Eliminates again what depends on these variables, in an order of its own with `newest` last;
  /// those that are not in the tree enter it. False, and the tree is empty, where the matrix is not
  /// positive definite.
  bool refactor(std::span<const int> variables, int newest);
  /// The same in the old order: where no measurement is new.
  bool relinearise(std::span<const int> variables);
  /// How many variables the last of both has eliminated.
  int refactored() const { return refactored_; }

  /// A step that is solved half: y = L⁻¹ b is in the tree.
  class Step {
   public:
    /// yᵀ y = bᵀ H⁻¹ b, by which F falls as far as it is quadratic.
    double promised() const { return promised_; }

   private:
    friend CliqueTree;
    Step(double promised, long number) : promised_(promised), number_(number) {}
    double promised_;
    long number_;
  };

  /// For b = ignored − gradient, which must be zero but at these variables; the other form is for
  /// any b.
  Step forward(std::span<const int> variables, const ByVariable<Vec3>& gradient,
               const ByVariable<Vec3>& ignored);
  Step forward_all(const ByVariable<Vec3>& gradient);

  /// Takes the step that was solved last, before anything else is asked of the tree: propagates
  /// H⁻¹ b from the root down. The keyframes of a clique follow one of their separators as if they
  /// were joined rigidly, and what is left of the separators' motion bends them. Where that is less
  /// than `negligible` squared sigmas, and b is zero below, all that is below follows rigidly,
  /// which is noted once at its top; or stays, if it would not move by more either. Nodes that are
  /// changed are saved.
  void propagate(const Step& step, double negligible);

  /// Of the last propagate: variables that moved and did not just follow.
  const std::vector<int>& bent() const { return last_.bent; }

  /// The node of a keyframe is up to date after this, until the next propagate; or those of all.
  void settle(int keyframe);
  void settle();

  /// From here on forget_update can take back what the update does. Schur complements that are too
  /// many are dropped, those first that were not needed for longest.
  void begin_update();
  /// All keyframes are where they were when the update began.
  void forget_update();
  /// All variables are there; nobody follows what was noted.
  void place(const ByVariable<Node>& nodes);

  /// One variable of each clique that the last propagate has bent, and whose keyframes have turned
  /// by more than `limit_rad` to each other since it was factored, or moved by more than `limit_m`
  /// and `limit_rad` of their distance.
  void find_to_relinearise(double limit_m, double limit_rad, std::vector<int>& variables) const;

  /// The derivative of a quantity by a variable, of a keyframe in its own axes.
  struct Response {
    int variable;
    Eigen::Matrix3d J;
  };
  /// J H⁻¹ Jᵀ of a quantity that depends on these variables of the tree and on keyframe 0; what is
  /// said twice of one adds up.
  Eigen::Matrix3d variance(const std::vector<Response>& responses);

 private:
  void grow();
  void mark_up(int variable);
  void mark_all();
  void sort_marked();
  void unmark();
  void find_affected(std::span<const int> variables);
  void sort_affected();
  void form_quotient_graph();
  void form_keyframe_graph();
  void release_marked();
  int older_than(int keyframe) const;
  const std::vector<int>& ordered(int first, int newest);
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
  void set_right_side(const ByVariable<Vec3>& gradient, const ByVariable<Vec3>* ignored);
  Step solved();
  double substitute();
  bool bend_separator(const Clique& clique, const RigidMotion& rigid, double negligible);
  bool has_moved(const Clique& clique, double negligible) const;
  void bend(int clique, double negligible);
  void follow(int clique, const RigidMotion& rigid);
  void settle_clique(int clique);
  void settle_path(int clique);
  void note_before_update(int clique);

  /// Which variable is eliminated where. build changes it, and clear.
  struct Order {
    ByVariable<int> clique_of;  ///< −1: not in the tree
    ByVariable<long> when;      ///< it was eliminated
    long next = 0;
    int root = -1;
  };

  /// What refactor eliminates again, and in which order; nobody else looks at it.
  struct Reordering {
    /// Variables to be eliminated, and keyframe 0: by age, errors before the pose of their picture.
    std::vector<int> affected;
    std::vector<int> orphans;  ///< children of cliques that are gone
    ByVariable<int> index_of;  ///< in affected; −1
    QuotientGraph quotient;
    bool has_errors = false;         ///< whether some are affected; then the order is that of
    QuotientGraph keyframes;         ///< the keyframes alone, and errors go with theirs
    std::vector<int> index_of_pose;  ///< by index in affected, of a pose that among the keyframes
    std::vector<int> pose_at;        ///< by index among the keyframes, that in affected
    std::vector<int> order;
    MinimumDegree minimum_degree;
    Elimination elimination;
    std::vector<int> built;
  };

  /// The Schur complements that are kept. factor makes them, drop_updates drops some.
  struct KeptUpdates {
    std::size_t most = 0;      ///< numbers in those that may be dropped
    std::size_t kept = 0;      ///< numbers in those that may be, now
    std::deque<int> queue;     ///< cliques whose update may be dropped
    bool has_dropped = false;  ///< whether any was
    BufferPool buffers;
  };

  /// Of the last propagate. bend writes it.
  struct Propagation {
    ByVariable<Node> before;  ///< where what it bent was
    std::vector<int> bent;
    std::vector<int> bent_cliques;
    long number = 0;  ///< how often propagate was called
  };

  /// Which cliques have a motion to follow. follow and settle change it.
  struct Following {
    bool has_any = false;   ///< whether there may be cliques with a motion to follow
    std::vector<int> told;  ///< those that this update has told to
  };

  /// Whose content matters to nobody after a call.
  struct Workspace {
    std::vector<int> to_factor;
    ByVariable<int> row_of;
    std::vector<double> packed;
    std::vector<double> signs;
    std::vector<double> gathered;
    std::vector<int> stack;
  };

  Problem& problem_;
  std::vector<Clique> cliques_;
  std::vector<int> free_;  ///< places in cliques_
  Order order_;
  Reordering again_;
  KeptUpdates updates_;
  Propagation last_;
  Following following_;
  Workspace work_;
  long update_ = 0;  ///< how many updates of the estimate have begun

  // The solve: from forward to propagate, y is that of the marked cliques and zero elsewhere.
  std::vector<int> marked_;
  ByVariable<Vec3> x_;  ///< b, then y
  long solves_ = 0;
  bool is_solved_ = false;
  int refactored_ = 0;
};

}  // namespace fathom::incremental_smoother
