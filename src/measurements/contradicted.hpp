#pragma once

#include <cstddef>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// The registrations, by number in order of arrival, whose χ² of 3 against all others (NaN: not
/// used) comes about with a probability below `level` over their number, and that are the worst of
/// those that share a picture with them: what one false loop does to its neighbours goes with it.
/// None at level 0.
std::vector<std::size_t> contradicted(const MeasurementLog& log, const std::vector<double>& chi2,
                                      double level);

}  // namespace fathom
