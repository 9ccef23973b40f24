// Legal calls of a built-in estimator: its options, steps and holes, what is measured of each
// keyframe, and questions in between. Whatever they are, it keeps its contract.
#include <algorithm>
#include <optional>

#include <Eigen/Eigenvalues>

#include "fathom/core/hash.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/guarded_estimator.hpp"
#include "support/call_draws.hpp"

namespace {

using namespace fathom;

constexpr std::size_t kMostKeyframes = 24;

// One life of an estimator, and all that it said as one number.
class Life {
 public:
  Life(GuardedEstimator& estimator, const EstimatorSetup& setup)
      : estimator_(estimator), start_(setup.start), mode_(setup.mode) {}

  void live(fuzz::Draws& draws) {
    if (!start_.is_fixed()) measure(draws, 0);
    while (!draws.is_empty() && estimator_.size() < kMostKeyframes) {
      const std::size_t k = estimator_.size();
      const std::uint8_t what = draws.byte();
      RelativePose step = fuzz::drawn_motion(draws, k - 1, k);
      // Of a batch solve all must hold together without the holes.
      step.is_hole = mode_ == SolveMode::incremental && what % 8 == 0;
      if (step.is_hole) holes_.push_back(k);
      estimator_.add_keyframe(step);
      if (what & 16) measure(draws, k);
      if (what & 32) ask(draws);
      require_kept();
    }
    note(estimator_.finish({}).outcome);
    ask(draws);
    require_kept();
  }

  std::uint64_t said() const { return said_.value(); }

 private:
  void require_kept() const { fuzz::require(estimator_.fault().empty(), estimator_.fault()); }

  void note(const Pose& pose) {
    for (const double value : {pose.x, pose.y, pose.theta}) said_.add(value);
  }
  void note(Outcome outcome) { said_.add(static_cast<std::int64_t>(outcome)); }

  // Of a covariance: symmetric and positive semi-definite, but for rounding.
  void note(const Eigen::MatrixXd& C) {
    constexpr double kRounding = 1e-6;
    for (Eigen::Index i = 0; i < C.size(); ++i) said_.add(C.data()[i]);
    const double norm = C.norm();
    fuzz::require((C - C.transpose()).norm() <= kRounding * norm, "a covariance is symmetric");
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(C, Eigen::EigenvaluesOnly);
    fuzz::require(solver.eigenvalues()(0) >= -kRounding * norm,
                  "a covariance is positive semi-definite");
  }

  // All of one keyframe in one update, which leaves the estimate as it was where it fails.
  void measure(fuzz::Draws& draws, std::size_t k) {
    std::vector<RelativePose> registrations;
    for (std::size_t left = k == 0 ? 0 : draws.below(4); left > 0; --left) {
      const std::size_t other = draws.below(k);
      const bool is_backward = draws.below(2) == 1;
      registrations.push_back(
          fuzz::drawn_motion(draws, is_backward ? k : other, is_backward ? other : k));
    }
    std::vector<AbsolutePose> absolute;
    if (k == 0 && start_.is_free) {
      absolute.push_back(
          AbsolutePose::from_covariance(0, start_.pose, fuzz::drawn_covariance(draws)));
    }
    for (std::size_t left = draws.below(3); left > 0; --left) {
      absolute.push_back(fuzz::drawn_absolute(draws, k));
    }
    if (registrations.empty() && absolute.empty()) return;
    const std::vector<Pose> before = poses_of(estimator_);
    const UpdateReport report = estimator_.update({registrations, absolute});
    note(report.outcome);
    require_kept();
    if (is_done(report.outcome) || may_bridge(registrations, absolute)) return;
    fuzz::require(poses_of(estimator_) == before, "a failed update leaves all as it was");
  }

  // Whether an update may bridge a hole, which stays bridged where the rest of it fails.
  bool may_bridge(const std::vector<RelativePose>& registrations,
                  const std::vector<AbsolutePose>& absolute) const {
    if (holes_.empty() || !absolute.empty()) return !holes_.empty();
    return std::ranges::any_of(registrations, [this](const RelativePose& z) {
      return std::ranges::any_of(holes_, [&](std::size_t hole) {
        return std::min(z.from, z.to) < hole && hole <= std::max(z.from, z.to);
      });
    });
  }

  void ask(fuzz::Draws& draws) {
    for (const Pose& pose : poses_of(estimator_)) note(pose);
    const std::size_t k = draws.below(estimator_.size());
    if (const auto C = estimator_.covariance(k)) note(Eigen::MatrixXd(*C));
    if (const auto C = estimator_.newest_covariance()) note(Eigen::MatrixXd(*C));
    const std::vector<std::size_t> some{k, draws.below(estimator_.size())};
    if (const auto C = estimator_.joint_covariance(some)) note(*C);
    if (const auto motions = estimator_.motions_to_newest()) {
      for (const UncertainPose& motion : *motions) note(Eigen::MatrixXd(motion.covariance));
    }
    for (const double weight : estimator_.loop_weights()) said_.add(weight);
    for (const double weight : estimator_.absolute_weights()) said_.add(weight);
    estimator_.moved_since(0);
  }

  GuardedEstimator& estimator_;
  StartPose start_;
  SolveMode mode_;
  std::vector<std::size_t> holes_;  // keyframes after them
  Hash said_;
};

std::optional<std::uint64_t> said_by_one(fuzz::Draws draws) {
  const std::vector<EstimatorEntry>& entries = builtin_estimators().entries();
  const EstimatorEntry& entry = entries[draws.below(entries.size())];
  const bool is_batch = entry.can_batch && draws.below(2) == 1;
  const SolveMode mode = is_batch ? SolveMode::batch : SolveMode::incremental;
  const EstimatorSetup setup{fuzz::drawn_start(draws, mode), mode};
  const EstimatorValues values = fuzz::drawn_values(draws, entry);
  std::optional<GuardedEstimator> estimator;
  // Options that do not go together are refused.
  if (!fuzz::is_taken([&] { estimator.emplace(entry, setup, values); })) {
    return std::nullopt;
  }
  Life life(*estimator, setup);
  life.live(draws);
  return life.said();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::Draws draws(data, size);
  fuzz::require(said_by_one(draws) == said_by_one(draws), "the same calls give the same estimate");
  return 0;
}
