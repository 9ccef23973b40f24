#pragma once

#include <initializer_list>

#include "ground.hpp"
#include "noise_field.hpp"

namespace fathom {

/// One train of ripples: a plane wave whose phase a relief in radians modulates. By several
/// radians, and crests wander and never come back to their spacing; by a few tenths, and they
/// repeat.
class Ripples {
 public:
  Ripples(cv::Size size, double metres_per_pixel, double wavelength_m, double heading_rad,
          std::initializer_list<Octave> astray_rad, RandomStream& stream);

  /// Height in [−1, 1] or so: crests narrower than troughs, as on sand.
  void row(int row, Row& out) const;

 private:
  Relief astray_;
  float per_column_;
  double per_row_;
};

}  // namespace fathom
