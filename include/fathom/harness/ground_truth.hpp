#pragma once

#include <cstddef>
#include <optional>

#include "fathom/configuration/study.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// The first frame of a keyframe, one every `separation_frames` from frame 0 on, without a true
/// pose; nothing where all have one.
std::optional<std::size_t> keyframe_without_truth(const FrameSource& frames, int separation_frames);

/// What refuses `association.reference: ground_truth` of frames that lack it.
InputError no_ground_truth(std::size_t frame);

/// Decides what selects the loop candidates of a study where its configuration leaves that to the
/// data (CandidateReference::Kind::automatic): ground truth where every keyframe of every cell has
/// it, else the estimate of an estimator that is no contender. Throws InputError where a cell asks
/// for ground truth that its data set does not have.
void settle_reference(Study& study, const EstimatorRegistry& registry);

}  // namespace fathom
