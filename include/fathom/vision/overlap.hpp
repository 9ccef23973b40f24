#pragma once

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// The share of the smaller one of two footprints that both pictures see, 0 to 1. `motion`: the
/// pose of b in the frame of a. Throws InputError on an altitude that is not positive.
double footprint_overlap(const Camera& camera, double altitude_a_m, double altitude_b_m,
                         const Pose& motion);

}  // namespace fathom
