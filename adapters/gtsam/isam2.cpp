#include <gtsam/nonlinear/ISAM2.h>
#include <memory>
#include <utility>

#include "adapters/gtsam/entries.hpp"
#include "adapters/gtsam/factors.hpp"
#include "adapters/support/graph_adapter.hpp"

namespace fathom {
namespace {

// The numbers are GTSAM's own defaults.
struct Isam2Options {
  double relinearize_threshold = 0.1;
  int relinearize_skip = 10;
  double wildfire_threshold = 1e-3;
  int updates = 1;
  int max_iterations = 1;
  double tolerance = 1e-5;
  bool exact_jacobians = false;
  GateOptions gate;

  void describe(OptionTable& table) {
    table.real("relinearize_threshold", relinearize_threshold, Range::positive(), "m, rad",
               "a node that has moved by more is linearised again");
    table.integer("relinearize_skip", relinearize_skip, Range::at_least(1), "",
                  "only every so many updates look for such nodes");
    table.real("wildfire_threshold", wildfire_threshold, Range::at_least(0.0), "m, rad",
               "back-substitution goes on where a node moves by more");
    table.integer("updates", updates, Range::at_least(1), "",
                  "calls of update() after each keyframe with loops; each is an iteration");
    table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                  "of other estimators; of no effect here, see updates");
    table.real("tolerance", tolerance, Range::at_least(0.0), "",
               "of other estimators; of no effect here");
    table.boolean("exact_jacobians", exact_jacobians,
                  "factors of the adapter, with Jacobians that GTSAM leaves a part out of");
    gate.describe(table);
  }

  void check(const EstimatorSetup& setup) const { check_gate(gate, setup, true); }
};

/// Steps wait until loops arrive: until then the estimate is dead reckoning from the last node that
/// ISAM2 has.
class Isam2 final : public RelativeEstimator {
 public:
  Isam2(const EstimatorSetup& setup, const Isam2Options& options)
      : options_(options),
        gate_(options.gate),
        isam_(parameters(options)),
        ahead_{setup.start.pose} {
    add_prior(waiting_.factors, setup.start.pose);
    waiting_.poses.insert(0, to_gtsam(setup.start.pose));
  }

  void add_keyframe(const RelativePose& step) override {
    const Pose guess = compose(pose(size() - 1), step.forward().motion);
    waiting_.poses.insert(size(), to_gtsam(guess));
    add_edge(waiting_.factors, step, options_.exact_jacobians);
    edges_.push_back(step);
    ahead_.push_back(guess);
    marginals_.reset();
  }

  UpdateReport close_loops(std::span<const RelativePose> loops) override {
    UpdateReport report;
    const auto covariances = [this](auto forward) { return predicted_covariances(*this, forward); };
    if (!judge(gate_, *this, loops, covariances, report)) {
      lose_all(report, Outcome::numerical_failure);
      return report;
    }
    Batch batch = waiting_;
    for (std::size_t j = 0; j < loops.size(); ++j) {
      if (report.loops[j].fate != LoopFate::used) continue;
      add_edge(batch.factors, loops[j], options_.exact_jacobians);
    }
    if (batch.factors.size() == waiting_.factors.size()) return report;
    report.iterations = options_.updates;
    if (take(batch, loops)) {
      for (std::size_t j = 0; j < loops.size(); ++j) {
        if (report.loops[j].fate == LoopFate::used) edges_.push_back(loops[j]);
      }
      return report;
    }
    restore();
    lose_all(report, Outcome::numerical_failure);
    return report;
  }

  /// ISAM2 cannot be told where a node is: it begins again, with all edges at the moved poses.
  std::optional<LoopDecision> bridge(const Bridge& bridge) override {
    std::vector<Pose> poses;
    for (std::size_t k = 0; k < size(); ++k) poses.push_back(pose(k));
    move_behind_hole(bridge, poses, edges_);
    isam_ = gtsam::ISAM2(parameters(options_));
    history_.clear();
    waiting_ = {};
    add_prior(waiting_.factors, poses[0]);
    for (const RelativePose& z : edges_) add_edge(waiting_.factors, z, options_.exact_jacobians);
    for (std::size_t k = 0; k < poses.size(); ++k) waiting_.poses.insert(k, to_gtsam(poses[k]));
    solved_ = 0;
    ahead_ = std::move(poses);
    marginals_.reset();
    return std::nullopt;
  }

  std::size_t size() const override { return solved_ + ahead_.size(); }

  Pose pose(std::size_t k) const override {
    if (k >= solved_) return ahead_[k - solved_];
    return from_gtsam(isam_.calculateEstimate<gtsam::Pose2>(k));
  }

  /// ISAM2's own, of the nodes that it has.
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override {
    if (k == 0) return Eigen::Matrix3d::Zero();
    if (k >= solved_) return RelativeEstimator::covariance(k);
    try {
      const gtsam::Values& poses = isam_.getLinearizationPoint();
      const auto X = poses.at<gtsam::Pose2>(k);
      return without_prior(isam_.marginalCovariance(k), X, X, poses.at<gtsam::Pose2>(0));
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }
  std::optional<Eigen::Matrix3d> newest_covariance() const override {
    return covariance(size() - 1);
  }

  /// ISAM2 has no joint covariances: of all its factors, linearised where it has linearised them.
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> nodes) const override {
    try {
      if (!marginals_) {
        gtsam::NonlinearFactorGraph factors = isam_.getFactorsUnsafe();
        factors.push_back(waiting_.factors);
        linearised_at_ = isam_.getLinearizationPoint();
        linearised_at_.insert(waiting_.poses);
        marginals_.emplace(factors, linearised_at_);
      }
      return joint_of(*marginals_, linearised_at_, nodes);
    } catch (const std::exception&) {
      return std::nullopt;
    }
  }

 private:
  /// What one update is given.
  struct Batch {
    gtsam::NonlinearFactorGraph factors;
    gtsam::Values poses;
  };

  static gtsam::ISAM2Params parameters(const Isam2Options& options) {
    gtsam::ISAM2Params parameters;
    parameters.optimizationParams = gtsam::ISAM2GaussNewtonParams(options.wildfire_threshold);
    parameters.relinearizeThreshold = options.relinearize_threshold;
    parameters.relinearizeSkip = options.relinearize_skip;
    return parameters;
  }

  void update_by(const Batch& batch) {
    isam_.update(batch.factors, batch.poses);
    for (int i = 1; i < options_.updates; ++i) isam_.update();
    isam_.getDelta();  // back-substitution, which it would put off to the next question
  }

  // False where it failed; ISAM2 is in no state to go on from then.
  bool take(const Batch& batch, std::span<const RelativePose> loops) {
    try {
      update_by(batch);
      for (const RelativePose& z : loops) {
        if (!is_finite(from_gtsam(isam_.calculateEstimate<gtsam::Pose2>(z.from))) ||
            !is_finite(from_gtsam(isam_.calculateEstimate<gtsam::Pose2>(z.to)))) {
          return false;
        }
      }
    } catch (const std::exception&) {
      return false;
    }
    solved_ += ahead_.size();
    ahead_.clear();
    waiting_ = {};
    marginals_.reset();
    history_.push_back(batch);
    return true;
  }

  // The same updates give the same state.
  void restore() {
    isam_ = gtsam::ISAM2(parameters(options_));
    for (const Batch& batch : history_) update_by(batch);
  }

  Isam2Options options_;
  Gate gate_;
  gtsam::ISAM2 isam_;
  std::vector<Batch> history_;
  std::vector<RelativePose> edges_;  ///< steps and loops that are used
  std::size_t solved_ = 0;
  Batch waiting_;
  std::vector<Pose> ahead_;  ///< of the nodes from solved_ on
  mutable std::optional<gtsam::Marginals> marginals_;
  mutable gtsam::Values linearised_at_;
};

}  // namespace

EstimatorEntry gtsam_isam2_entry() {
  EstimatorEntry entry = make_relative_entry<Isam2Options>(
      "gtsam_isam2", "ISAM2 of GTSAM, fluid relinearisation in a Bayes tree", false,
      [](const EstimatorSetup& setup, const Isam2Options& options) {
        return std::make_unique<Isam2>(setup, options);
      });
  entry.unused_options = {"max_iterations", "tolerance"};
  return entry;
}

}  // namespace fathom
