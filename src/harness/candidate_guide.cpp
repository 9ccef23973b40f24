#include "candidate_guide.hpp"

#include <cstdint>
#include <string>

#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/guarded_estimator.hpp"

namespace fathom {
namespace {

// The estimate of an estimator. Where it turns out faulty, dead reckoning takes its place.
class EstimateGuide : public CandidateGuide {
 public:
  EstimateGuide(const EstimatorEntry& entry, const EstimatorValues& values)
      : estimator_(entry, {}, values) {}

  void add_keyframe(const Keyframe& keyframe) override {
    const Pose motion = keyframe.step ? keyframe.step->motion : Pose{};
    dead_reckoning_.append(keyframe.step ? compose(newest_, motion) : Pose{});
    newest_ = dead_reckoning_.pose(dead_reckoning_.size() - 1);
    if (keyframe.step) estimator_.add_keyframe(*keyframe.step);
  }

  void close_loops(std::span<const RelativePose> registrations) override {
    estimator_.close_loops(registrations);
  }

  const TrajectoryView& trajectory() override {
    look_for_faults();
    if (estimator_.fault().empty()) return estimator_;
    return dead_reckoning_;
  }

 private:
  // The guard looks at every pose that it is asked for.
  void look_for_faults() {
    const MovedPoses moved = estimator_.moved_since(revision_);
    revision_ = moved.revision;
    for (const std::size_t k : moved.keyframes.value_or(consecutive(0, estimator_.size()))) {
      if (!estimator_.fault().empty()) return;
      estimator_.pose(k);
    }
  }

  GuardedEstimator estimator_;
  std::uint64_t revision_ = 0;
  GivenTrajectory dead_reckoning_;
  Pose newest_;
};

class TruthGuide : public CandidateGuide {
 public:
  explicit TruthGuide(const FrameSource& frames) : frames_(frames) {}

  void add_keyframe(const Keyframe& keyframe) override {
    truth_.append(frames_.info(keyframe.frame).ground_truth.value());
  }
  void close_loops(std::span<const RelativePose> /*registrations*/) override {}
  const TrajectoryView& trajectory() override { return truth_; }

 private:
  const FrameSource& frames_;
  GivenTrajectory truth_;
};

}  // namespace

std::unique_ptr<CandidateGuide> make_guide(const CandidateReference& reference,
                                           const EstimatorRegistry& registry,
                                           const FrameSource& frames,
                                           const KeyframeOptions& keyframes) {
  using Kind = CandidateReference::Kind;
  if (reference.kind != Kind::estimate) {
    const auto missing = keyframe_without_truth(frames, keyframes);
    if (!missing) return std::make_unique<TruthGuide>(frames);
    if (reference.kind == Kind::ground_truth) throw no_ground_truth(*missing);
  }
  const EstimatorConfiguration& estimator = reference.estimator;
  return std::make_unique<EstimateGuide>(registry.find(estimator.type), estimator.values);
}

}  // namespace fathom
