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

/// Entries in rows between two columns of pixels.
class PlotLegend {
 public:
  PlotLegend(std::vector<LegendEntry> entries, double left_px, double right_px);

  double height_px() const;
  void draw(Canvas& canvas, double top_px) const;

 private:
  struct Place {
    double left_px = 0.0;
    int row = 0;
  };
  std::vector<LegendEntry> entries_;
  std::vector<Place> places_;
  int rows_ = 0;
};

}  // namespace fathom
