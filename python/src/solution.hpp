#pragma once

#include <memory>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"

namespace fathom {

/// One estimator's estimate of a log, judged, and what it was made of.
struct Solution {
  std::shared_ptr<const Recording> recording;
  Result result;
  std::vector<std::string> remarks{};  ///< what looks wrong, sentences
};

/// Ctrl-C ends a replay at its next keyframe, in a child at once. To be called without the lock.
void check_signals();

}  // namespace fathom
