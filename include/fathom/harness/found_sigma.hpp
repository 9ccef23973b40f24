#pragma once

#include <string>

#include "fathom/measurements/variance_components.hpp"

namespace fathom {

/// A standard deviation of what pictures share, as the survey's own loops have it: found, or not
/// determined by them, and then as assumed.
struct FoundSigma {
  VarianceComponent::Part part = VarianceComponent::Part::tilt;
  bool is_found = false;
  double in_force = 0.0;  ///< m, rad, or a factor, as its option has it
  double low = 0.0;       ///< 95 % interval, where it is found
  double high = 0.0;
  std::size_t registrations = 0;  ///< that it rests on
  std::size_t contradicted = 0;   ///< that the others contradict, left out
};

/// Such as "roll and pitch: 21 mrad [18, 25], from 231 loops".
std::string words(const FoundSigma& sigma);

}  // namespace fathom
