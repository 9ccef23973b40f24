#pragma once

#include <optional>
#include <vector>

#include "fathom/measurements/decision.hpp"
#include "fathom/report/trajectory_plot.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// An absolute measurement of a run as its study stored it, in the frame of the aligned estimate.
struct StoredAbsolute {
  AbsoluteMark mark;
  LoopFate fate = LoopFate::used;
  double weight = 1.0;
  std::optional<double> nis;
};

/// Those of one run with `poses` keyframes, in their order; none where the store was written
/// without what was measured.
std::vector<StoredAbsolute> stored_absolute(const ResultStore& store, const RunKey& key,
                                            std::size_t poses);

/// What pictures show of them.
std::vector<AbsoluteMark> marks_of(const std::vector<StoredAbsolute>& all);

}  // namespace fathom
