#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fathom {

/// What an axis shows, and in what unit its values are given; an empty one for counts and ratios.
struct AxisTitle {
  std::string text;
  std::string unit;
};

/// One axis of a chart, in the unit of the values that it was made from.
struct ChartAxis {
  std::string title;  ///< with the unit of the ticks' texts, which may have a prefix
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  bool grid = false;
  bool keeps_labels = false;  ///< all of them: smaller or turned rather than left out
  std::vector<std::pair<double, std::string>> ticks;

  /// 0 at `low` to 1 at `high`.
  double share(double value) const;
};

/// Encloses all values, zero too if `from_zero`. Values must be finite; without any, 0 to 1.
ChartAxis axis_over(const AxisTitle& title, const std::vector<double>& values, bool from_zero);

/// From `low` to `high` as they are.
ChartAxis axis_between(const AxisTitle& title, double low, double high);

/// A logarithmic one encloses the values above zero, to the next 1, 2 or 5.
ChartAxis logarithmic_axis_over(const AxisTitle& title, const std::vector<double>& values);

/// Whether values read best on a logarithmic axis: all are above zero, they span a decade or more,
/// and their quotients differ no more than their differences do.
bool are_geometric(std::vector<double> values);

/// One tick for each text, at its position; logarithmic where positions are geometric.
ChartAxis labelled_axis(const std::string& title, const std::vector<double>& positions,
                        const std::vector<std::string>& texts, double margin_share);

/// The least of 1, 2 and 5 times a power of ten that is no less than `least` > 0.
double round_step(double least);

/// A number with as many decimals as its step has; from steps of 1e6 with an exponent.
std::string coordinate_text(double value, double step);

}  // namespace fathom
