#pragma once

#include <span>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// The log with the responses G to errors of altitude as they are without the registrations' own
/// errors ν, which own_errors at the optimum of the poses tell.
///
/// Of pictures of a floor, whose first error is that of the altitude. G is taken from matched
/// points, so that altitude_from G_from + altitude_to G_to is the measured motion z, ν included. A
/// scale common to all poses and altitudes then scales ν, too, and F is smaller on a smaller map
/// (docs/shared_errors.md says by how much). Taken half from each end, ν leaves the sum.
///
/// `altitudes_m`, as measured, by keyframe. ν counts up to ten of its standard deviations; an end
/// whose altitude has no σ is left alone.
MeasurementLog with_adjusted_responses(const MeasurementLog& log, std::span<const Pose> optimum,
                                       std::span<const double> altitudes_m);

}  // namespace fathom
