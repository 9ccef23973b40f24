#pragma once

#include <initializer_list>

#include "ground.hpp"
#include "noise_field.hpp"

namespace fathom {

/// One train of ripples. Its phase is a plane wave's, led astray by a relief in radians: of several
/// radians, and crests wander and never come back to their spacing; of a few tenths, and they
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
