#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

/// How a lens bends what it shows; the formulas, and the order of the coefficients, are OpenCV's.
enum class DistortionModel {
  radial_tangential,  ///< Brown: 1 + k1 r² + k2 r⁴ + k3 r⁶, and p1, p2
  equidistant,  ///< a fisheye (Kannala and Brandt): θ (1 + k1 θ² + k2 θ⁴ + k3 θ⁶ + k4 θ⁸)
  rational_polynomial,  ///< Brown's over 1 + k4 r² + k5 r⁴ + k6 r⁶
};

struct DistortionEntry {
  DistortionModel model;
  std::string name;  ///< in files and configurations
  std::vector<std::string> coefficients;
  std::size_t fewest;  ///< how many a file may give; the others are zero

  /// "[k1, k2, k3, k4]"
  std::string list() const;
};

const std::vector<DistortionEntry>& distortion_models();
const DistortionEntry& entry_of(DistortionModel model);

}  // namespace fathom
