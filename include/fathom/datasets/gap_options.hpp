#pragma once

#include <optional>

#include "fathom/core/options.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// What is declared of a motion over a hole in dead reckoning, of which nothing was measured.
struct GapOptions {
  std::optional<double> sigma_m;  ///< absent: from the speed limit
  double sigma_rad = 1.8;         ///< that of any heading is π / √3
  double speed_limit_m_s = 2.0;

  /// Keys `gap_sigma_m`, `gap_sigma_rad`, `speed_limit_m_s`.
  void describe(OptionTable& table);

  /// No motion, with the declared covariance: σ of x and of y is `sigma_m`, else the way that the
  /// speed limit allows in so long.
  UncertainPose motion(double duration_s) const;
};

}  // namespace fathom
