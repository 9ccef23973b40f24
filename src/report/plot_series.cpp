#include "plot_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "fathom/report/palette.hpp"

namespace fathom {

bool is_drawable(const Pose& pose) {
  constexpr double kFarthest = 1e9;
  return is_finite(pose) && std::abs(pose.x) <= kFarthest && std::abs(pose.y) <= kFarthest;
}

std::vector<Stroke> strokes_of(const std::vector<PlotSeries>& all) {
  std::vector<Stroke> strokes(all.size());
  double width_px = 2.2;
  for (std::size_t i = all.size(); i-- > 0;) {
    const Colour colour = series_colour(all[i].name);
    if (all[i].name == "dead reckoning") {
      strokes[i] = {colour, 2.2, 10.0};
    } else {
      const bool is_truth = all[i].name == "ground truth";
      strokes[i] = {is_truth ? tint(colour, 0.55) : colour,
                    is_truth ? std::max(width_px, 5.0) : width_px};
      width_px = std::min(width_px + 1.8, 8.0);
    }
  }
  return strokes;
}

std::vector<Eigen::Vector2d> two_sigma_ellipse(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d P = covariance.topLeftCorner<2, 2>();
  if (!P.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(P);
  if (solver.info() != Eigen::Success || !(solver.eigenvalues().minCoeff() > 0.0)) return {};
  const Eigen::Vector2d axes = 2.0 * solver.eigenvalues().cwiseSqrt();
  std::vector<Eigen::Vector2d> polygon;
  constexpr int kCorners = 72;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    polygon.push_back(solver.eigenvectors() *
                      Eigen::Vector2d(axes.x() * std::cos(angle), axes.y() * std::sin(angle)));
  }
  return polygon;
}

namespace {

constexpr double kLeastEllipsePx = 1.5;  // smaller ones would hide in the line

void draw_line(Canvas& canvas, const MapView& view, const PlotSeries& series,
               const Stroke& stroke) {
  std::vector<Eigen::Vector2d> piece;
  const auto finish_piece = [&] {
    canvas.line(piece, stroke);
    if (piece.size() == 1) canvas.disc(piece.front(), stroke.width_px, stroke.colour);
    piece.clear();
  };
  for (const Pose& pose : series.poses) {
    if (is_drawable(pose)) {
      piece.push_back(view.pixel(pose.position()));
    } else {
      finish_piece();
    }
  }
  finish_piece();
}

void draw_loops(Canvas& canvas, const MapView& view, const PlotSeries& series) {
  for (const auto& [from, to] : series.loops) {
    const Pose& a = series.poses[from];
    const Pose& b = series.poses[to];
    if (!is_drawable(a) || !is_drawable(b)) continue;
    canvas.line({view.pixel(a.position()), view.pixel(b.position())},
                {tint(series_colour(series.name), kLoopTint), 1.0});
  }
}

// Where ellipses stand: spread evenly along the drawn line, the last pose always among them.
std::vector<std::size_t> ellipse_places(const MapView& view, const PlotSeries& series,
                                        int max_ellipses) {
  std::vector<double> along_px(series.poses.size(), 0.0);
  std::size_t before = series.poses.size();
  double length = 0.0;
  for (std::size_t k = 0; k < series.poses.size(); ++k) {
    if (!is_drawable(series.poses[k])) continue;
    if (before < k) {
      length += view.pixels_per_metre() *
                (series.poses[k].position() - series.poses[before].position()).norm();
    }
    along_px[k] = length;
    before = k;
  }
  constexpr double kLeastSpacing = 45.0;
  const double spacing = std::max(kLeastSpacing, length / std::max(1, max_ellipses));
  std::vector<std::size_t> places;
  double next = length;
  for (std::size_t k = series.poses.size(); k-- > 0;) {
    if (!is_drawable(series.poses[k]) || along_px[k] > next) continue;
    places.push_back(k);
    next = along_px[k] - spacing;
  }
  return places;
}

void draw_ellipses(Canvas& canvas, const MapView& view, const PlotSeries& series,
                   int max_ellipses) {
  if (series.covariances.empty()) return;
  const Stroke stroke{tint(series_colour(series.name), kEllipseTint), 1.4};
  for (const std::size_t k : ellipse_places(view, series, max_ellipses)) {
    std::vector<Eigen::Vector2d> polygon = two_sigma_ellipse(series.covariances[k]);
    double largest_px = 0.0;
    for (Eigen::Vector2d& corner : polygon) {
      largest_px = std::max(largest_px, corner.norm() * view.pixels_per_metre());
      corner = view.pixel(series.poses[k].position() + corner);
    }
    if (largest_px >= kLeastEllipsePx) canvas.closed_line(polygon, stroke);
  }
}

void draw_ends(Canvas& canvas, const MapView& view, const TrajectoryPlot& plot) {
  bool start_drawn = false;
  for (const PlotSeries& series : plot.series) {
    const auto last = std::find_if(series.poses.rbegin(), series.poses.rend(), is_drawable);
    if (last == series.poses.rend()) continue;
    canvas.square(view.pixel(last->position()), 5.0, series_colour(series.name));
    if (start_drawn || !is_drawable(series.poses.front())) continue;
    canvas.ring(view.pixel(series.poses.front().position()), 8.0, {palette::black, 2.0});
    start_drawn = true;
  }
}

}  // namespace

void draw_series(Canvas& canvas, const MapView& view, const TrajectoryPlot& plot) {
  for (const PlotSeries& series : plot.series) draw_loops(canvas, view, series);
  const std::vector<Stroke> strokes = strokes_of(plot.series);
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    draw_line(canvas, view, plot.series[i], strokes[i]);
  }
  for (const PlotSeries& series : plot.series) {
    draw_ellipses(canvas, view, series, plot.max_ellipses);
  }
  draw_ends(canvas, view, plot);
}

}  // namespace fathom
