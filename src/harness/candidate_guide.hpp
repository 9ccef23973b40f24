#pragma once

#include <memory>

#include "fathom/configuration/configuration.hpp"
#include "fathom/estimation/estimator.hpp"
#include "fathom/front_end/front_end.hpp"

namespace fathom {

/// Runs along with the front end while it records, and says where the keyframes are, by which loop
/// candidates are selected.
class CandidateGuide {
 public:
  virtual ~CandidateGuide() = default;
  /// Every keyframe in its order, keyframe 0 too.
  virtual void add_keyframe(const Keyframe& keyframe) = 0;
  /// What was measured of the newest keyframe, if anything was: of the world before its candidates
  /// are searched, registrations after that.
  virtual void update(const Measurements& measurements) = 0;
  /// Of all keyframes so far; valid until the next call.
  virtual const TrajectoryView& trajectory() = 0;
};

/// The guide that a reference asks for. `automatic` is ground truth where all frames that may be
/// keyframes have it (keyframe_without_truth). Throws InputError that begins with the key where
/// ground truth is asked for and one has none.
std::unique_ptr<CandidateGuide> make_guide(const CandidateReference& reference,
                                           const EstimatorRegistry& registry,
                                           const FrameSource& frames,
                                           const KeyframeOptions& keyframes,
                                           const StartPose& start);

}  // namespace fathom
