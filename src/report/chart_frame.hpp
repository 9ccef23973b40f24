#pragma once

#include <string>
#include <utility>
#include <vector>

#include "estimator_colours.hpp"
#include "vector_canvas.hpp"

namespace fathom {

/// One axis of a chart.
struct ChartAxis {
  std::string title;
  double low = 0.0;
  double high = 1.0;
  bool logarithmic = false;
  /// Where the ticks are; of none given, round numbers.
  std::vector<std::pair<double, std::string>> ticks;

  /// 0 at `low` to 1 at `high`.
  double share(double value) const;
};

/// Encloses all values, zero too if `from_zero`; a logarithmic one those above zero, to the next
/// 1, 2 or 5.
ChartAxis axis_over(std::string title, const std::vector<double>& values, bool from_zero);
ChartAxis logarithmic_axis_over(std::string title, const std::vector<double>& values);

/// The axes of a chart with its grid, and the way from values to points of the page.
class ChartFrame {
 public:
  ChartFrame(ChartAxis x, ChartAxis y, const Box& box);

  void draw(VectorCanvas& canvas) const;
  Eigen::Vector2d at(double x, double y) const;
  const Box& box() const { return box_; }

 private:
  void draw_x_ticks(VectorCanvas& canvas, const Pen& pen) const;

  ChartAxis x_;
  ChartAxis y_;
  Box box_;
};

struct FigureLegendEntry {
  std::string text;
  Pen pen;
};

/// Entries side by side from the left, in as many rows as they need; the height that they take.
double draw_figure_legend(VectorCanvas& canvas, const std::vector<FigureLegendEntry>& entries,
                          const Eigen::Vector2d& top_left, double width);

/// How an estimator's line is drawn in figures.
Pen pen_of(const LineStyle& style, double width);

inline constexpr double kFontSize = 7.5;
inline constexpr Colour kSoftInk{0x55, 0x5B, 0x61};

}  // namespace fathom
