#pragma once

#include <cstddef>
#include <optional>

#include "fathom/configuration/study.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/keyframes.hpp"

namespace fathom {

/// The first frame without a true pose of those that may be keyframes: one every
/// `separation_frames`, or any frame where keyframes go by overlap. Nothing where all have one.
std::optional<std::size_t> keyframe_without_truth(const FrameSource& frames,
                                                  const KeyframeOptions& keyframes);

/// What refuses `association.reference: ground_truth` of frames that lack it.
InputError no_ground_truth(std::size_t frame);

/// Decides what selects the loop candidates of a study where its configuration leaves that to the
/// data (CandidateReference::Kind::automatic): ground truth where every keyframe of every cell has
/// it, else the estimate of an estimator that is no contender. Throws InputError where a cell asks
/// for ground truth that its data set does not have.
void settle_reference(Study& study, const EstimatorRegistry& registry);

}  // namespace fathom
