#pragma once

#include <string>

namespace fathom {

/// What an axis says of its numbers: a value times `factor` is in `text`, which may be "mm", "µs"
/// or "× 10⁻⁶", and is empty for plain numbers.
struct ScaledUnit {
  std::string text;
  double factor = 1.0;
};

/// The unit ("m", "rad", "ms", "s", "bytes", any other, or none) with the prefix that leaves the
/// greatest number of an axis one to three digits before its point. From 0.01 to 10 000, and plain
/// numbers to 1 000 000, it stays as it is.
ScaledUnit scaled_unit(const std::string& unit, double greatest);

/// "10⁻⁷"
std::string power_of_ten(int exponent);

}  // namespace fathom
