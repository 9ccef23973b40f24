#pragma once

#include <string>

#include "fathom/measurements/variance_components.hpp"

namespace fathom {

/// A standard deviation of what pictures share, as the survey's own loops have it; or as assumed,
/// where they do not tell it or what they tell is a fault of the set-up.
struct FoundSigma {
  VarianceComponent::Part part = VarianceComponent::Part::tilt;
  double in_force = 0.0;  ///< m, rad, or a factor, as its option has it
  double by_loops = 0.0;  ///< likewise, with its 95 % interval
  double low = 0.0;
  double high = 0.0;
  std::size_t registrations = 0;  ///< that it rests on
  std::size_t contradicted = 0;   ///< that the others contradict, left out
  std::string refusal;            ///< why what loops tell is not in force; empty where it is

  bool is_found() const { return refusal.empty(); }
};

/// Such as "roll and pitch: 21 mrad [18, 25], from 231 loops".
std::string words(const FoundSigma& sigma);

}  // namespace fathom
