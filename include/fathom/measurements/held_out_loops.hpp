#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Of each registration of a log, in order of arrival, whether it is held out: an estimate without
/// it is judged by it (cross-validation). Each pair of keyframes is drawn by itself with
/// probability `share`, by a hash of seed, trial and pair: logs that differ in other pairs agree in
/// this one, and a greater share holds out the same ones and more.
///
/// Never held out are a registration of consecutive keyframes, which is a step, one that `is_false`
/// (empty: none is known to be), and one without which a keyframe behind a hole would be joined to
/// the others no longer.
std::vector<bool> draw_held_out(const MeasurementLog& log, const std::vector<bool>& is_false,
                                double share, std::uint64_t seed, std::uint64_t trial);

/// The log without the registrations that are held out.
MeasurementLog log_without(const MeasurementLog& log, const std::vector<bool>& is_held_out);

/// Those registrations, in order of arrival.
std::vector<RelativePose> held_out_of(const MeasurementLog& log,
                                      const std::vector<bool>& is_held_out);

}  // namespace fathom
