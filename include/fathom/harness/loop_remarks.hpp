#pragma once

#include <span>
#include <string>
#include <vector>

#include "fathom/front_end/options.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// What of a survey's loops looks wrong: each one line with its numbers and the likeliest remedy.
/// `estimate` is of all keyframes.
std::vector<std::string> loop_remarks(const Recording& recording, const FrontEndOptions& options,
                                      std::span<const Pose> estimate);

}  // namespace fathom
