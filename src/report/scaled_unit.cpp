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
  return {"", 0, 0, 0};
}

int thousands_of(double value) {
  return static_cast<int>(std::floor(std::log10(value) / 3.0 + 1e-9));
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
  if (base.unit.empty()) {
    // A unit without prefixes, or none: the power of ten is said beside it.
    const int thousands = thousands_of(greatest);
    const std::string power = "× " + power_of_ten(3 * thousands);
    return {power + (unit.empty() ? "" : " " + unit), std::pow(1000.0, -thousands)};
  }
  const int thousands = std::clamp(thousands_of(greatest) + base.thousands, base.least, base.most);
  const int place = thousands + kNoPrefix;
  const std::string prefix(kPrefixes[static_cast<std::size_t>(place)]);
  return {prefix + std::string(base.unit), std::pow(1000.0, base.thousands - thousands)};
}

ScaledUnit reading_unit(const std::string& unit, double value) {
  const double size = std::abs(value);
  if (!(size > 0.0) || !std::isfinite(size)) return {unit, 1.0};
  const Base base = base_of(unit);
  if (base.unit.empty()) {
    if (size >= 0.001 && size < 1e6) return {unit, 1.0};
    const int thousands = thousands_of(size);
    const std::string power = "× " + power_of_ten(3 * thousands);
    return {power + (unit.empty() ? "" : " " + unit), std::pow(1000.0, -thousands)};
  }
  int thousands = thousands_of(size) + base.thousands;
  const double in_next = size * std::pow(1000.0, base.thousands - thousands - 1);
  if (thousands < -1 && in_next >= 0.00999) ++thousands;
  thousands = std::clamp(thousands, base.least, base.most);
  const int place = thousands + kNoPrefix;
  const std::string prefix(kPrefixes[static_cast<std::size_t>(place)]);
  return {prefix + std::string(base.unit), std::pow(1000.0, base.thousands - thousands)};
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
  std::string text = format_number(value * scale.factor, kDigits);
  if (!scale.text.empty()) text += " " + scale.text;
  if (!interval) return text;
  return text + " [" + format_number(interval->low * scale.factor, kDigits) + ", " +
         format_number(interval->high * scale.factor, kDigits) + "]";
}

}  // namespace fathom
