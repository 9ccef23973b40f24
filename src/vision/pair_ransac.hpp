#pragma once

#include <cstdint>

#include "fathom/vision/ransac.hpp"
#include "point_pairs.hpp"

namespace fathom {

/// ransac() of pairs that may know their turns.
Consensus ransac(const PointPairs& pairs, const RansacOptions& options, std::uint64_t seed,
                 const RansacTuning& tuning);

}  // namespace fathom
