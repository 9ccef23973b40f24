#pragma once

#include <span>

#include "fathom/front_end/calibration.hpp"

namespace fathom {

/// By how much motions are likelier as their ends lie between two rows: interpolation averages
/// noise there. Of a motion of K rows whose ends are the shares f and g of a row beyond one, white
/// noise has K − f (1 − f) − g (1 − g) times the variance of a row.
double gain_of_interpolation(const RecordedOdometry& odometry, std::span<const SeenMotion> motions,
                             double offset_s);

}  // namespace fathom
