#pragma once

#include <functional>
#include <string>
#include <vector>

#include "canvas.hpp"

namespace fathom {

/// One entry: a sample, drawn by a function about its centre, and what it means.
struct LegendEntry {
  std::string text;
  std::function<void(Canvas&, const Eigen::Vector2d& centre)> sample;
};

/// A line, a disc, and the mark of a style.
LegendEntry line_entry(const std::string& text, const Pen& pen);
LegendEntry disc_entry(const std::string& text, Colour colour);
LegendEntry mark_entry(const std::string& text, const LineStyle& style);

/// Entries side by side from the left, in as many rows as they need within a width. One that is
/// wider than that is shortened.
class ChartLegend {
 public:
  ChartLegend(std::vector<LegendEntry> entries, double width);

  double height() const;
  void draw(Canvas& canvas, const Eigen::Vector2d& top_left) const;

 private:
  struct Place {
    double left = 0.0;
    int row = 0;
  };
  std::vector<LegendEntry> entries_;
  std::vector<Place> places_;
  int rows_ = 0;
};

}  // namespace fathom
