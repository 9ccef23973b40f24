#pragma once

#include <optional>

#include "fathom/core/options.hpp"

namespace fathom {

/// `dataset.start`: where keyframe 0 is in the world, and how well that is known.
struct StartOptions {
  std::optional<double> x_m;
  std::optional<double> y_m;
  std::optional<double> heading_rad;
  double sigma_m = 0.0;    ///< of x and of y
  double sigma_rad = 0.0;  ///< of the heading

  void describe(OptionTable& table);

  bool has_position() const { return x_m.has_value(); }

  /// Throws InputError naming `prefix` + the key: one of x and y alone, or a sigma of what is not
  /// given.
  void check(const std::string& prefix) const;
};

}  // namespace fathom
