#pragma once

#include <string>
#include <vector>

#include "src/report/chart_frame.hpp"

namespace fathom::benchmarks {

struct Curve {
  std::vector<Eigen::Vector2d> points;
  Pen pen;
  bool has_discs = true;  ///< one at each point
};

/// The pen of the solver or estimator at this place.
Pen pen_of(std::size_t place);

/// Curves over two logarithmic axes; nothing where there is no point.
void draw_curves(Canvas& canvas, const std::vector<Curve>& curves, const AxisTitle& x,
                 const AxisTitle& y, const Box& box);

}  // namespace fathom::benchmarks
