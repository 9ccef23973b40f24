#pragma once

#include <opencv2/core.hpp>

#include "fathom/core/random.hpp"

namespace fathom {

/// Strews stones over a picture of a floor, 8-bit grey: single ones, heaps, and pebbles, each with
/// an outline of its own, lit from the upper left and with a shadow.
void strew_stones(cv::Mat& floor, double metres_per_pixel, RandomStream& stream);

}  // namespace fathom
