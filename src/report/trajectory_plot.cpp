#include "fathom/report/trajectory_plot.hpp"

#include <algorithm>

#include "canvas.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/report/palette.hpp"
#include "map_view.hpp"
#include "plot_legend.hpp"
#include "plot_series.hpp"

namespace fathom {
namespace {

void check(const TrajectoryPlot& plot) {
  if (plot.width_px < 400 || plot.height_px < 300) {
    throw InputError("a trajectory plot must be at least 400 x 300 pixels, got " +
                     std::to_string(plot.width_px) + " x " + std::to_string(plot.height_px));
  }
  for (const PlotSeries& series : plot.series) {
    if (!series.covariances.empty() && series.covariances.size() != series.poses.size()) {
      throw InputError("'" + series.name + "' has " + std::to_string(series.poses.size()) +
                       " poses and " + std::to_string(series.covariances.size()) +
                       " covariances; there must be one per pose, or none");
    }
    for (const auto& [from, to] : series.loops) {
      if (std::max(from, to) >= series.poses.size()) {
        throw InputError("'" + series.name + "' has a loop from pose " + std::to_string(from) +
                         " to " + std::to_string(to) + ", but only " +
                         std::to_string(series.poses.size()) + " poses");
      }
    }
  }
}

std::string full_title(const TrajectoryPlot& plot) {
  std::size_t left_out = 0;
  for (const PlotSeries& series : plot.series) {
    for (const Pose& pose : series.poses) left_out += is_drawable(pose) ? 0 : 1;
  }
  if (left_out == 0) return plot.title;
  return plot.title + (plot.title.empty() ? "" : "  ") + "[" + std::to_string(left_out) +
         (left_out == 1 ? " pose is" : " poses are") + " not finite or too far, not drawn]";
}

std::vector<LegendEntry> legend_entries(const TrajectoryPlot& plot) {
  std::vector<LegendEntry> entries;
  bool any_loop = false;
  bool any_ellipse = false;
  bool any_pose = false;
  const std::vector<Stroke> strokes = strokes_of(plot.series);
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    const Stroke stroke = strokes[i];
    entries.push_back(
        {series.name + (series.poses.empty() ? " (no poses)" : ""),
         [stroke](Canvas& canvas, const Eigen::Vector2d& at) {
           canvas.line({at - Eigen::Vector2d(24, 0), at + Eigen::Vector2d(24, 0)}, stroke);
         }});
    any_loop = any_loop || !series.loops.empty();
    any_ellipse = any_ellipse || !series.covariances.empty();
    any_pose = any_pose || !series.poses.empty();
  }
  if (any_loop) {
    entries.push_back({"loop closure", [](Canvas& canvas, const Eigen::Vector2d& at) {
                         canvas.line({at - Eigen::Vector2d(24, 0), at + Eigen::Vector2d(24, 0)},
                                     {tint(palette::black, kLoopTint), 1.0});
                       }});
  }
  if (any_ellipse) {
    entries.push_back({"2-sigma ellipse", [](Canvas& canvas, const Eigen::Vector2d& at) {
                         std::vector<Eigen::Vector2d> polygon =
                             two_sigma_ellipse(Eigen::Vector3d(64, 16, 1).asDiagonal());
                         for (Eigen::Vector2d& corner : polygon) corner += at;
                         canvas.closed_line(polygon, {tint(palette::black, kEllipseTint), 1.4});
                       }});
  }
  if (any_pose) {
    entries.push_back({"start", [](Canvas& canvas, const Eigen::Vector2d& at) {
                         canvas.ring(at, 8.0, {palette::black, 2.0});
                       }});
    entries.push_back({"end", [](Canvas& canvas, const Eigen::Vector2d& at) {
                         canvas.square(at, 5.0, palette::black);
                       }});
  }
  return entries;
}

std::vector<Eigen::Vector2d> drawable_points(const TrajectoryPlot& plot) {
  std::vector<Eigen::Vector2d> points;
  for (const PlotSeries& series : plot.series) {
    for (const Pose& pose : series.poses) {
      if (is_drawable(pose)) points.push_back(pose.position());
    }
  }
  return points;
}

}  // namespace

cv::Mat render(const TrajectoryPlot& plot) {
  check(plot);
  constexpr double kLeft = 110.0;
  constexpr double kTitleBaseline = 44.0;
  constexpr double kLegendTop = 62.0;
  Canvas canvas(plot.width_px, plot.height_px);
  const double right = plot.width_px - 40.0;
  const PlotLegend legend(legend_entries(plot), kLeft, right);
  const std::vector<Eigen::Vector2d> points = drawable_points(plot);
  PixelBox frame{kLeft, kLegendTop + legend.height_px() + 38.0, right, plot.height_px - 70.0};
  // Long coordinates take more room at the left.
  frame.left = std::max(kLeft, MapView(points, frame).label_width_px() + 24.0);
  const MapView view(points, frame);

  const std::string title = full_title(plot);
  canvas.text(title, {kLeft, kTitleBaseline},
              Canvas::fitting_height_px(title, 22.0, right - kLeft));
  legend.draw(canvas, kLegendTop);
  view.draw_grid(canvas);
  if (points.empty()) {
    canvas.text("no poses", {0.5 * (frame.left + frame.right), frame.top + 40.0}, 22.0,
                TextAnchor::centre);
  }
  canvas.clip_to(frame);
  draw_series(canvas, view, plot);
  return canvas.finish();
}

}  // namespace fathom
