#include "curves.hpp"

namespace fathom::benchmarks {

Pen pen_of(std::size_t place) {
  const LineStyle style = estimator_style(place);
  return {style.colour, 1.4, style.dashes, 1.0};
}

void draw_curves(Canvas& canvas, const std::vector<Curve>& curves, const AxisTitle& x,
                 const AxisTitle& y, const Box& box) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Curve& curve : curves) {
    for (const Eigen::Vector2d& point : curve.points) {
      xs.push_back(point.x());
      ys.push_back(point.y());
    }
  }
  if (xs.empty()) return;
  const ChartFrame frame(logarithmic_axis_over(x, xs), logarithmic_axis_over(y, ys), box);
  frame.draw(canvas);
  for (const Curve& curve : curves) {
    const std::vector<Eigen::Vector2d> line = frame.at(curve.points);
    if (line.size() > 1) canvas.line(line, curve.pen);
    if (!curve.has_discs) continue;
    for (const Eigen::Vector2d& point : line) canvas.disc(point, 1.8, curve.pen.colour);
  }
}

}  // namespace fathom::benchmarks
