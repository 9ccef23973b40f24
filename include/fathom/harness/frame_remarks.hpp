#pragma once

#include <optional>
#include <string>

#include "fathom/harness/recording.hpp"

namespace fathom {

/// How many frames share no floor with the keyframe before them nor with the one after, by dead
/// reckoning and with footprints of the smaller of both altitudes: no registration says where they
/// are. Nothing where there are none, or no pictures.
std::optional<std::string> frame_remark(const Recording& recording);

/// How many keyframes have no ground truth, where some frames have: no error is computed then.
std::optional<std::string> truth_remark(const Recording& recording);

}  // namespace fathom
