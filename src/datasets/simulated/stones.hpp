#pragma once

#include <opencv2/core.hpp>

#include "fathom/core/random.hpp"

namespace fathom {

/// Stones of one kind on a floor.
struct Stones {
  double per_square_metre;
  double smallest_m;  ///< radius
  double largest_m;
  int heap;            ///< stones in each place
  double heap_size_m;  ///< standard deviation of their distance from it
};

/// Strews stones over a picture of a floor, 8-bit grey, each with an outline of its own, lit from
/// the upper left and with a shadow.
void strew(cv::Mat& floor, double metres_per_pixel, const Stones& kind, RandomStream& stream);

/// Digs burrows into it: dark holes, each in a low cone of what was dug out.
void dig_burrows(cv::Mat& floor, double metres_per_pixel, RandomStream& stream);

}  // namespace fathom
