#pragma once

#include <cstddef>
#include <vector>

#include "odometry_steps.hpp"

namespace fathom {

/// The readings at which the odometry starts again: steps that lead back to the first pose (nine
/// tenths of the way to it or more), at more than `factor` times the speed that 99 in 100 of the
/// other steps stay below.
std::vector<std::size_t> odometry_restarts(const std::vector<OdometryReading>& readings,
                                           double factor);

}  // namespace fathom
