#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fathom/evaluation/interval.hpp"

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

/// The unit in which a value reads best within a text or a table: one to three digits before the
/// point, and thousandths down to 0.01 (0.040 mm rather than 40 µm). Plain numbers stay from 0.001
/// to 1 000 000.
ScaledUnit reading_unit(const std::string& unit, double value);

/// The same rule as a table, by rising magnitude: from `least` on, a value reads best in `unit`;
/// below the first in the first, and zero in `unit` itself.
struct UnitStep {
  double least = 0.0;
  ScaledUnit unit;
};
std::vector<UnitStep> reading_units(const std::string& unit);

/// "17.4 mm", "5.01 × 10⁻⁶"
std::string quantity(double value, const std::string& unit);

/// "17.4 mm [16.1, 18.4]", in the unit that suits the greatest of them.
std::string quantity(double value, const std::optional<Interval>& interval,
                     const std::string& unit);

/// The same in a given unit.
std::string quantity(double value, const std::optional<Interval>& interval,
                     const ScaledUnit& scale);

/// "10⁻⁷"
std::string power_of_ten(int exponent);

}  // namespace fathom
