#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

namespace fathom {

/// A picture of a sea floor, 8-bit grey: sand ripples that wander, fork and fade, dark patches,
/// mottled and grained sand, stones and pebbles with shadows. Nothing repeats. The same arguments
/// give the same picture, whatever the number of threads. Both sizes in pixels, > 0.
cv::Mat draw_sea_floor(cv::Size size, double metres_per_pixel, std::uint64_t seed);

}  // namespace fathom
