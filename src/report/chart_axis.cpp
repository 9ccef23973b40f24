#include "chart_axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "fathom/core/text.hpp"
#include "scaled_unit.hpp"

namespace fathom {
namespace {

std::string titled(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " (" + unit + ")";
}

void add_round_ticks(ChartAxis& axis, double factor) {
  const double step = round_step((axis.high - axis.low) / 7.0);
  // So far from zero that no label would tell two ticks apart.
  if (std::max(std::abs(axis.low), std::abs(axis.high)) / step > 1e9) return;
  const auto first = static_cast<long>(std::ceil(axis.low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(axis.high / step + 1e-9));
  for (long i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    axis.ticks.emplace_back(value, coordinate_text(value * factor, step * factor));
  }
}

// So many decades have powers of ten alone, of which some are left out.
void add_powers(ChartAxis& axis, int first, int last) {
  const int step = std::max(1, static_cast<int>(std::ceil((last - first) / 8.0)));
  for (int power = first; power <= last; power += step) {
    axis.ticks.emplace_back(std::pow(10.0, power), power_of_ten(power));
  }
}

void add_logarithmic_ticks(ChartAxis& axis, double factor) {
  const double decades = std::log10(axis.high / axis.low);
  for (int power = static_cast<int>(std::floor(std::log10(axis.low))) - 1;
       std::pow(10.0, power) <= axis.high * 1.001; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, power);
      const bool inside = value >= axis.low * 0.999 && value <= axis.high * 1.001;
      if (inside && (digit == 1.0 || decades < 2.5)) {
        char text[32];
        std::snprintf(text, sizeof text, "%.6g", value * factor);
        axis.ticks.emplace_back(value, text);
      }
    }
  }
}

// The greatest of 1, 2 and 5 times a power of ten that is at most the value.
double rounded_down(double value) {
  const double ten = std::pow(10.0, std::floor(std::log10(value)));
  return value >= 5.0 * ten ? 5.0 * ten : value >= 2.0 * ten ? 2.0 * ten : ten;
}

}  // namespace

double ChartAxis::share(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
}

double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

std::string coordinate_text(double value, double step) {
  if (value == 0.0) value = 0.0;  // no -0
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  char buffer[48];
  if (step >= 1e6) {
    std::snprintf(buffer, sizeof buffer, "%g", value);
  } else {
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  }
  return buffer;
}

ChartAxis axis_between(const AxisTitle& title, double low, double high) {
  ChartAxis axis;
  axis.low = low;
  axis.high = high;
  // By the span: a prefix is to make the steps easy to read, wherever the axis begins.
  const ScaledUnit unit = scaled_unit(title.unit, high - low);
  axis.title = titled(title.text, unit.text);
  add_round_ticks(axis, unit.factor);
  return axis;
}

ChartAxis axis_over(const AxisTitle& title, const std::vector<double>& values, bool from_zero) {
  double low = 0.0;
  double high = 1.0;
  if (!values.empty()) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    low = from_zero ? std::min(0.0, *least) : *least;
    high = from_zero ? std::max(0.0, *most) : *most;
  }
  // Nothing but one value, or what doubles cannot tell from it.
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(high - low > 1e-9 * size)) high = low + (size > 0.0 ? size : 1.0);
  if (from_zero) {
    const double margin = 0.04 * (high - low);
    if (high > 0.0) high += margin;
    if (low < 0.0) low -= margin;
  }
  return axis_between(title, low, high);
}

ChartAxis logarithmic_axis_over(const AxisTitle& title, const std::vector<double>& values) {
  std::vector<double> positive;
  std::copy_if(values.begin(), values.end(), std::back_inserter(positive),
               [](double value) { return value > 0.0; });
  if (positive.empty()) positive = {1.0};
  const auto [least, most] = std::minmax_element(positive.begin(), positive.end());
  ChartAxis axis;
  axis.logarithmic = true;
  axis.low = rounded_down(*least);
  axis.high = 1.0 / rounded_down(1.0 / *most);
  if (!(axis.high > axis.low)) axis.high = 10.0 * axis.low;
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  if (last - first >= 6) {
    axis.title = titled(title.text, title.unit);
    add_powers(axis, first, last);
    return axis;
  }
  const ScaledUnit unit = scaled_unit(title.unit, axis.high);
  axis.title = titled(title.text, unit.text);
  add_logarithmic_ticks(axis, unit.factor);
  return axis;
}

bool are_geometric(std::vector<double> values) {
  std::ranges::sort(values);
  if (values.empty() || values.front() <= 0.0) return false;
  if (values.back() < 10.0 * values.front() * (1.0 - 1e-9)) return false;
  std::vector<double> differences;
  std::vector<double> quotients;
  for (std::size_t i = 1; i < values.size(); ++i) {
    differences.push_back(values[i] - values[i - 1]);
    quotients.push_back(std::log(values[i] / values[i - 1]));
  }
  const auto least_share = [](const std::vector<double>& steps) {
    return std::ranges::min(steps) / std::ranges::max(steps);
  };
  return least_share(quotients) >= least_share(differences);
}

ChartAxis labelled_axis(const std::string& title, const std::vector<double>& positions,
                        const std::vector<std::string>& texts, double margin_share) {
  ChartAxis axis = axis_over({title, ""}, positions, false);
  axis.title = title;
  axis.keeps_labels = true;
  axis.logarithmic = are_geometric(positions);
  if (axis.logarithmic) {
    const double margin = std::pow(axis.high / axis.low, margin_share);
    axis.low /= margin;
    axis.high *= margin;
  } else {
    const double margin = margin_share * (axis.high - axis.low);
    axis.low -= margin;
    axis.high += margin;
  }
  axis.ticks.clear();
  for (std::size_t i = 0; i < positions.size(); ++i)
    axis.ticks.emplace_back(positions[i], texts[i]);
  return axis;
}

}  // namespace fathom
