#include "scaled_unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "fathom/report/table.hpp"

namespace fathom {
namespace {

constexpr std::array<std::string_view, 9> kPrefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
constexpr int kNoPrefix = 4;
constexpr int kMostThousands = 102;  // of a double

// A unit as the power of a thousand of another: 1 ms is the -1st of s.
struct Base {
  std::string_view unit;
  int thousands = 0;
  int least = -4;  ///< bytes are not divided, nor is a radian multiplied
  int most = 4;
};

Base base_of(const std::string& unit) {
  if (unit == "m") return {"m", 0, -4, 1};
  if (unit == "rad") return {"rad", 0, -4, 0};
  if (unit == "s") return {"s", 0, -4, 0};
  if (unit == "ms") return {"s", -1, -4, 0};
  if (unit == "bytes") return {"B", 0, 0, 4};
  return {"", 0, -kMostThousands, kMostThousands};
}

int thousands_of(double value) {
  return static_cast<int>(std::floor(std::log10(value) / 3.0 + 1e-9));
}

// The least value that reads best at this power of a thousand of the base: one, and a hundredth of
// a thousandth part and of what is less.
double least_at(const Base& base, int thousands) {
  const bool has_hundredths = !base.unit.empty() && thousands < 0;
  return (has_hundredths ? 0.00999 : 1.0 - 7e-9) * std::pow(1000.0, thousands - base.thousands);
}

// The base at that power, by its prefix or with the power said beside the unit.
ScaledUnit unit_at(const Base& base, const std::string& unit, int thousands) {
  if (!base.unit.empty()) {
    const int place = thousands + kNoPrefix;
    const std::string prefix(kPrefixes[static_cast<std::size_t>(place)]);
    return {prefix + std::string(base.unit), std::pow(1000.0, base.thousands - thousands)};
  }
  if (thousands == 0) return {unit, 1.0};
  const std::string power = "× " + power_of_ten(3 * thousands);
  return {power + (unit.empty() ? "" : " " + unit), std::pow(1000.0, -thousands)};
}

}  // namespace

std::string power_of_ten(int exponent) {
  static constexpr std::array<std::string_view, 10> kDigits{"⁰", "¹", "²", "³", "⁴",
                                                            "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "10";
  for (const char digit : std::to_string(exponent)) {
    text += digit == '-' ? "⁻" : kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

ScaledUnit scaled_unit(const std::string& unit, double greatest) {
  if (!(greatest > 0.0) || !std::isfinite(greatest)) return {unit, 1.0};
  const Base base = base_of(unit);
  const double most = base.unit.empty() ? 1e6 : 1e4;
  if (greatest > 0.00999 && greatest < 1.0001 * most) return {unit, 1.0};
  const int thousands = thousands_of(greatest) + base.thousands;
  return unit_at(base, unit, std::clamp(thousands, base.least, base.most));
}

ScaledUnit reading_unit(const std::string& unit, double value) {
  const double size = std::abs(value);
  if (!(size > 0.0) || !std::isfinite(size)) return {unit, 1.0};
  const Base base = base_of(unit);
  int thousands = std::clamp(thousands_of(size) + base.thousands + 1, base.least, base.most);
  while (thousands > base.least && size < least_at(base, thousands)) --thousands;
  if (base.unit.empty() && (thousands == -1 || thousands == 1)) thousands = 0;
  return unit_at(base, unit, thousands);
}

std::vector<UnitStep> reading_units(const std::string& unit) {
  const Base base = base_of(unit);
  std::vector<UnitStep> steps;
  for (int thousands = base.least; thousands <= base.most; ++thousands) {
    if (base.unit.empty() && (thousands == 0 || thousands == 1)) continue;
    // A plain number stays as it is from the step below one on.
    const bool is_plain = base.unit.empty() && thousands == -1;
    steps.push_back({least_at(base, thousands), unit_at(base, unit, is_plain ? 0 : thousands)});
  }
  return steps;
}

std::string quantity(double value, const std::string& unit) {
  return quantity(value, std::nullopt, unit);
}

std::string quantity(double value, const std::optional<Interval>& interval,
                     const std::string& unit) {
  double greatest = std::abs(value);
  if (interval) greatest = std::max({greatest, std::abs(interval->low), std::abs(interval->high)});
  return quantity(value, interval, reading_unit(unit, greatest));
}

std::string quantity(double value, const std::optional<Interval>& interval,
                     const ScaledUnit& scale) {
  constexpr int kDigits = 3;
  const std::string number = format_number(value * scale.factor, kDigits);
  const std::string unit = scale.text.empty() ? "" : " " + scale.text;
  if (!interval) return number + unit;
  const std::string range = " [" + format_number(interval->low * scale.factor, kDigits) + ", " +
                            format_number(interval->high * scale.factor, kDigits) + "]";
  // A unit is understood of the ends, a power of ten is not.
  return scale.text.starts_with("×") ? "(" + number + range + ")" + unit : number + unit + range;
}

}  // namespace fathom
