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
  EstimateGuide(const EstimatorEntry& entry, const EstimatorValues& values, const StartPose& start)
      : estimator_(entry, {start, SolveMode::incremental}, values), newest_(start.pose) {}

  void add_keyframe(const Keyframe& keyframe) override {
    if (keyframe.step) {
      newest_ = compose(newest_, keyframe.step->motion);
      estimator_.add_keyframe(*keyframe.step);
    }
    dead_reckoning_.append(newest_);
  }

  void update(const Measurements& measurements) override { estimator_.update(measurements); }

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
  void update(const Measurements& /*measurements*/) override {}
  const TrajectoryView& trajectory() override { return truth_; }

 private:
  const FrameSource& frames_;
  GivenTrajectory truth_;
};

}  // namespace

std::unique_ptr<CandidateGuide> make_guide(const CandidateReference& reference,
                                           const EstimatorRegistry& registry,
                                           const FrameSource& frames,
                                           const KeyframeOptions& keyframes,
                                           const StartPose& start) {
  using Kind = CandidateReference::Kind;
  if (reference.kind != Kind::estimate) {
    const auto missing = keyframe_without_truth(frames, keyframes);
    if (!missing) return std::make_unique<TruthGuide>(frames);
    if (reference.kind == Kind::ground_truth) throw no_ground_truth(*missing);
  }
  const EstimatorConfiguration& estimator = reference.estimator;
  return std::make_unique<EstimateGuide>(registry.find(estimator.type), estimator.values, start);
}

}  // namespace fathom
