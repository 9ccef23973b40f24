#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "estimators/incremental_smoother/gradient.hpp"
#include "estimators/support/pose_graph/minimum_search.hpp"
#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/precision.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::incremental_smoother {

struct SmootherLimits {
  int max_iterations = 100;
  double tolerance = 1e-5;
  double relinearise_m = 0.01;
  double relinearise_rad = 0.001;

  /// What propagation leaves of a step behind it, as a share of what F may exceed its optimum by:
  /// it adds up over the branches of the tree (docs/estimators/incremental_smoother.md).
  double bend_share = 0.1;
  /// Where F is large, so is what it may exceed its optimum by: this many times F a keyframe. It
  /// does not grow with the map, so full steps become rarer as they become longer.
  double bend_share_of_mean_cost = 12.0;
  /// As of SolverTuning: differences of F that are rounding, and the least that a step may promise.
  double rounding_chi2 = 1e-12;
  double least_promise_chi2 = 1e-20;
  /// A loop is eliminated again where its weight has left that in the tree by more, as a share. Of
  /// a matrix that is off by a share δ, a step leaves at most δ² of what F exceeds its minimum by:
  /// one in a hundred, as of a chord that goes on (SolverTuning::chord_contraction).
  double reweight_share = 0.1;
  /// With a loss an update takes so many steps of its own gradient at most, then so many of the
  /// whole one, then Newton's of the whole graph. A step leaves λ² of what F exceeds its minimum by
  /// (left_by_step); where that is a half, ten steps leave a thousandth.
  int steps_of_a_kind = 10;
  /// Of λ as one step shows it: the next ones show more.
  double most_lost_curvature = 0.99;
  /// With the errors of pictures: everything is linearised at the estimate where a whole step
  /// promises a larger share of what the one before did.
  double stale_contraction = 0.25;
  /// Where F falls below this share of what it was, its running sum is added up anew: ten digits of
  /// it are left.
  double cancellation = 1e-6;
  /// Of Schur complements; some more are kept whatever their bytes.
  std::size_t most_kept_bytes = std::size_t{128} << 20U;
};

/// Which pictures' errors are unknowns beside the poses: of none; of each whose registrations share
/// some; or of those alone that have several registrations (Pictures).
enum class ErrorStates { none, all, of_several };

struct SmootherResult {
  Outcome outcome = Outcome::converged;
  int iterations = 0;
};

/// What all updates did.
struct Counts {
  long steps = 0;
  long whole_steps = 0;  ///< of them those with the gradient at all keyframes
  long eliminated = 0;   ///< variables
  long batch_solves = 0;
};

/// The estimate of a growing pose graph, kept at its optimum.
class Smoother {
 public:
  Smoother(const Pose& origin, const SmootherLimits& limits, const RobustLoss& loss = {},
           ErrorStates error_states = ErrorStates::none);

  /// Keyframes that follow a part of the map are moved when they are asked for.
  const Problem& problem();
  std::size_t size() const { return problem_.nodes.size(); }
  Pose pose(std::size_t k);
  /// As of TrajectoryView; registrations may move any.
  MovedPoses moved_since(std::uint64_t revision) const;

  /// A keyframe at the newest one ⊕ the step. It enters the factor with the next registrations.
  void add_keyframe(const RelativePose& step);
  /// As of RelativeEstimator.
  void bridge(const Bridge& bridge);
  /// Minimises F with these registrations added; as it was before where that fails.
  SmootherResult add_registrations(std::span<const RelativePose> registrations);

  /// Covariance of h(x) for each of these registrations, of h(x) + G_from n_from + G_to n_to where
  /// n are unknowns; nothing where there is none.
  std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
      std::span<const RelativePose> forward_loops);

  /// Of (x, y, θ) of the newest keyframe, world axes, keyframe 0 fixed; nothing where there is
  /// none.
  std::optional<Eigen::Matrix3d> newest_covariance();

  /// Each as its innovation is to be tested: the errors of its pictures, as estimated, taken out,
  /// and of its own covariance.
  std::vector<RelativePose> without_errors(std::span<const RelativePose> registrations);

  /// What each of the registrations added weighs at the estimate, in their order; and the graph
  /// with the information that is left of theirs. With a loss; without one all weigh 1.
  std::vector<double> loop_weights() const;
  pose_graph::ExtendedGraph weighted_graph();

  const Counts& counts() const { return counts_; }
  const LoopWeights& loops() const { return problem_.loops; }

 private:
  /// Where an update stands.
  struct Progress {
    bool is_whole = false;  ///< the next step is of the gradient at all keyframes
    bool is_fresh = false;  ///< the whole tree is linearised at the estimate
    bool is_over = false;
    int local_steps = 0;
    int whole_steps = 0;
    double lost_curvature = 0.0;                                      ///< λ of the last step
    double promised_whole = std::numeric_limits<double>::infinity();  ///< by the last whole step
    SmootherResult result;
  };

  /// Keyframes that the tree does not have yet: add_keyframe appends, refactor takes them in.
  struct Outside {
    int first = 1;                     ///< the first of them
    std::vector<UncertainPose> steps;  ///< to this keyframe and those that follow it
  };

  /// What an update has to look at again. add_registrations begins anew; its steps add.
  struct Marks {
    std::vector<int> touched;         ///< variables of new edges, to be eliminated again
    std::vector<int> to_relinearise;  ///< variables of cliques to be linearised again
    std::vector<int> changed;         ///< variables whose gradient this update has changed
    ByVariable<long> changed_in;      ///< the last update that did
    std::vector<long> edge_pass;      ///< by edge: the last pass that evaluated it
    long pass = 0;
    long update = 0;
  };

  /// For moved_since.
  struct Revisions {
    std::uint64_t now = 1;       ///< one more with every keyframe and with every update
    std::uint64_t moved_in = 1;  ///< the revision of the last update
  };

  void append_edge(const RelativePose& measurement, bool is_loop);
  bool has_states(const RelativePose& z) const {
    return error_states_ != ErrorStates::none && z.shared != nullptr;
  }
  void grow_errors();
  void unfold(int keyframe);
  void touch_ends(const Edge& edge);
  /// use(variable) for all errors that are unknowns.
  template <class Use>
  void for_each_state(Use use) const {
    for (int k = 0; k < static_cast<int>(problem_.error_count()); ++k) {
      if (problem_.pictures.has(k)) use(errors_of(k));
    }
  }
  void add_loops(std::span<const RelativePose> registrations);
  void evaluate_all();
  bool refactor();
  bool relinearise();
  void drop_tree();
  bool rebuild();
  bool keeps_digits();
  void search_lower(SmootherResult& result);
  SmootherResult iterate();
  bool prepare_step(const Progress& progress);
  double negligible_bend() const;
  void take_step(Progress& progress);
  double left_by_step(Progress& progress, double promised, double brought) const;
  bool goes_on_locally(Progress& progress, double left, double most_slack) const;
  bool wants_newton(Progress& progress) const;
  bool contracts(Progress& progress, double promised) const;
  void retreat(Progress& progress);
  void linearise_afresh(Progress& progress);
  static void end(Progress& progress, Outcome outcome);
  void note_changed(int variable);
  void reevaluate_bent();
  void reevaluate_prior(int keyframe);
  void solve_whole(Progress& progress);
  SmootherResult solve_batch();
  SmootherResult solve_rows();
  void place(const pose_graph::ExtendedGraph& solved);
  pose_graph::ExtendedGraph extended(const std::vector<Edge>& edges) const;
  SmootherResult minimise_whole(pose_graph::ExtendedGraph& graph) const;
  void undo(int edges_before);
  /// One that could not be built again after a failure knows nothing.
  bool has_tree() const { return at(problem_.size() - outside_.first) == outside_.steps.size(); }

  /// A motion by the tree, and its derivatives.
  struct MotionInTree {
    Pose mean;
    std::vector<CliqueTree::Response> responses{};
  };
  MotionInTree motion_in_tree(int from, int to);
  /// The newest keyframe that `variance` knows.
  int last_inside() const { return has_tree() ? outside_.first - 1 : problem_.size() - 1; }
  std::optional<Eigen::Matrix3d> variance(const std::vector<CliqueTree::Response>& responses);
  std::optional<Eigen::Matrix3d> motion_covariance(int from);
  std::optional<Eigen::Matrix3d> shared_covariance(const RelativePose& z);

  SmootherLimits limits_;
  ErrorStates error_states_;
  Problem problem_;
  CliqueTree tree_;
  Gradient gradient_;
  InformationSpread spread_;
  pose_graph::WideRows wide_rows_;  ///< of the edges of the problem
  ByVariable<Node> before_step_;    ///< all nodes, of a step of the whole gradient
  ByVariable<Vec3> ignored_;        ///< what earlier updates left of it
  double slack_ = 0.0;              ///< the slack on the cost: by how much F may exceed its optimum

  Outside outside_;
  Marks marks_;
  pose_graph::MinimumSearch search_;
  Revisions revisions_;
  Counts counts_;
};

}  // namespace fathom::incremental_smoother
