#pragma once

#include <span>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// A pose per keyframe, as a batch solve needs it to begin with where dead reckoning has holes:
/// stretches without a hole stand as dead reckoning has them, each put where the first registration
/// that joins it to those already placed says; else where absolute measurements say (rigid_fit);
/// else by the guess over its hole. With a free start all is put where those measurements say.
std::vector<Pose> connected_guess(const MeasurementLog& log);

/// The motion of the world that brings poses near the absolute measurements of their keyframes, in
/// closed form: the heading by those that measure headings, failing them by the positions; then the
/// position. What is not measured stays. `keyframes`: the indices of the poses, rising.
Pose rigid_fit(const MeasurementLog& log, std::span<const std::size_t> keyframes,
               std::span<const Pose> poses);

}  // namespace fathom
