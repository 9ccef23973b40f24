#include "trajectory_map.hpp"

#include <algorithm>
#include <utility>

#include "absolute_marks.hpp"
#include "map_frame.hpp"
#include "map_pens.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kLoopTint = 0.35;
constexpr double kEllipseTint = 0.75;
constexpr double kStartRadius = 3.2;
constexpr double kEndHalf = 2.0;
// Nearer than a line is broad, as a share of a map's longer side.
constexpr double kTogether = 1.0 / 300.0;

Eigen::AlignedBox2d extent_of(const PlotSeries& series) {
  Eigen::AlignedBox2d extent;
  for (const Pose& pose : series.poses) {
    if (is_drawable(pose)) extent.extend(pose.position());
  }
  return extent;
}

Eigen::AlignedBox2d extent_of(const std::vector<PlotSeries>& all) {
  Eigen::AlignedBox2d near;
  Eigen::AlignedBox2d whole;
  for (const PlotSeries& series : all) {
    whole.extend(extent_of(series));
    if (!series.may_leave) near.extend(extent_of(series));
  }
  if (near.isEmpty()) return whole;
  return whole.sizes().maxCoeff() > 2.5 * near.sizes().maxCoeff() ? near : whole;
}

// World to page: y is along the first axis, from high to low.
Eigen::Vector2d placed(const ChartFrame& frame, const Eigen::Vector2d& world) {
  return frame.at(world.y(), world.x());
}

void draw_line(Canvas& canvas, const ChartFrame& frame, const PlotSeries& series, const Pen& pen) {
  Points piece;
  const auto finish_piece = [&] {
    canvas.line(piece, pen);
    if (piece.size() == 1) canvas.disc(piece.front(), pen.width, pen.colour);
    piece.clear();
  };
  for (const Pose& pose : series.poses) {
    if (is_drawable(pose)) {
      piece.push_back(placed(frame, pose.position()));
    } else {
      finish_piece();
    }
  }
  finish_piece();
}

void draw_loops(Canvas& canvas, const ChartFrame& frame, const PlotSeries& series) {
  const Pen pen{tint(series.style.colour, kLoopTint), 0.4, {}, 1.0};
  for (const auto& [from, to] : series.loops) {
    const Pose& a = series.poses[from];
    const Pose& b = series.poses[to];
    if (!is_drawable(a) || !is_drawable(b)) continue;
    canvas.line(placed(frame, a.position()), placed(frame, b.position()), pen);
  }
}

// Where ellipses stand: spread evenly along the drawn line, the last pose always among them.
std::vector<std::size_t> ellipse_places(const ChartFrame& frame, const PlotSeries& series,
                                        int max_ellipses) {
  std::vector<double> along(series.poses.size(), 0.0);
  const Pose* last = nullptr;
  double length = 0.0;
  for (std::size_t k = 0; k < series.poses.size(); ++k) {
    const Pose& pose = series.poses[k];
    if (!is_drawable(pose)) continue;
    if (last != nullptr) {
      length += (placed(frame, pose.position()) - placed(frame, last->position())).norm();
    }
    along[k] = length;
    last = &pose;
  }
  constexpr double kLeastSpacing = 18.0;
  const double spacing = std::max(kLeastSpacing, length / std::max(1, max_ellipses));
  std::vector<std::size_t> places;
  double next = length;
  for (std::size_t k = series.poses.size(); k-- > 0;) {
    if (!is_drawable(series.poses[k]) || along[k] > next) continue;
    places.push_back(k);
    next = along[k] - spacing;
  }
  return places;
}

void draw_ellipses(Canvas& canvas, const ChartFrame& frame, const PlotSeries& series,
                   int max_ellipses) {
  if (series.covariances.empty()) return;
  constexpr double kLeast = 0.6;  // smaller ones would hide in the line
  const Pen pen{tint(series.style.colour, kEllipseTint), 0.6, {}, 1.0};
  for (const std::size_t k : ellipse_places(frame, series, max_ellipses)) {
    Points polygon = two_sigma_ellipse(series.covariances[k]);
    const Eigen::Vector2d centre = series.poses[k].position();
    double largest = 0.0;
    for (Eigen::Vector2d& corner : polygon) {
      corner = placed(frame, centre + corner);
      largest = std::max(largest, (corner - placed(frame, centre)).norm());
    }
    if (largest >= kLeast) canvas.outline(polygon, pen);
  }
}

void draw_ends(Canvas& canvas, const ChartFrame& frame, const std::vector<PlotSeries>& all) {
  bool start_drawn = false;
  for (const PlotSeries& series : all) {
    const auto last = std::find_if(series.poses.rbegin(), series.poses.rend(), is_drawable);
    if (last == series.poses.rend()) continue;
    canvas.square(placed(frame, last->position()), kEndHalf, series.style.colour);
    if (start_drawn || !is_drawable(series.poses.front())) continue;
    canvas.ring(placed(frame, series.poses.front().position()), kStartRadius,
                {palette::black, 0.8, {}, 1.0});
    start_drawn = true;
  }
}

LegendEntry turns_entry() {
  return {"alternating: they agree", [](Canvas& canvas, const Eigen::Vector2d& centre) {
            const Eigen::Vector2d half(8.0, 0.0);
            canvas.line(centre - half, centre + half, {palette::black, 1.4, {}, 1.0});
            canvas.line(centre - half, centre + half,
                        {tint(palette::black, kLoopTint), 1.4, {4.0, 4.0}, 1.0});
          }};
}

LegendEntry ellipse_entry() {
  return {"2σ ellipse", [](Canvas& canvas, const Eigen::Vector2d& centre) {
            Points polygon = two_sigma_ellipse(Eigen::Vector3d(9.0, 2.0, 1.0).asDiagonal());
            for (Eigen::Vector2d& corner : polygon) corner += centre;
            canvas.outline(polygon, {tint(palette::black, kEllipseTint), 0.6, {}, 1.0});
          }};
}

LegendEntry start_entry() {
  return {"start", [](Canvas& canvas, const Eigen::Vector2d& centre) {
            canvas.ring(centre, kStartRadius, {palette::black, 0.8, {}, 1.0});
          }};
}

LegendEntry end_entry() {
  return {"end", [](Canvas& canvas, const Eigen::Vector2d& centre) {
            canvas.square(centre, kEndHalf, palette::black);
          }};
}

}  // namespace

Eigen::AlignedBox2d map_extent(const std::vector<PlotSeries>& all) {
  return with_fixes(extent_of(all), all);
}

TrajectoryMap::TrajectoryMap(const TrajectoryPlot& plot)
    : plot_(plot), pens_(map_pens(plot.series)), drawn_(pens_), low_(-1.0, -1.0), high_(1.0, 1.0) {
  const Eigen::AlignedBox2d extent = map_extent(plot.series);
  if (extent.isEmpty()) return;
  low_ = extent.min();
  high_ = extent.max();
  do_take_turns_ = take_turns(plot.series, kTogether * extent.sizes().maxCoeff(), drawn_);
}

bool TrajectoryMap::leaves(const PlotSeries& series) const {
  const Eigen::AlignedBox2d shown(low_, high_);
  const Eigen::AlignedBox2d own = extent_of(series);
  return !own.isEmpty() && !shown.contains(own);
}

std::vector<LegendEntry> TrajectoryMap::legend() const {
  std::vector<LegendEntry> entries;
  bool any_loop = false;
  bool any_ellipse = false;
  bool any_pose = false;
  for (std::size_t i = 0; i < plot_.series.size(); ++i) {
    const PlotSeries& series = plot_.series[i];
    const char* note = series.poses.empty() ? " (no poses)"
                       : leaves(series)     ? " (leaves the picture)"
                                            : "";
    entries.push_back(line_entry(series.name + note, pens_[i]));
    any_loop = any_loop || !series.loops.empty();
    any_ellipse = any_ellipse || !series.covariances.empty();
    any_pose = any_pose || !series.poses.empty();
  }
  if (do_take_turns_) entries.push_back(turns_entry());
  if (any_loop) {
    const Pen pen{tint(palette::black, kLoopTint), 0.4, {}, 1.0};
    entries.push_back(line_entry("loop closure", pen));
  }
  for (LegendEntry& mark : absolute_legend(plot_.series, {low_, high_})) {
    entries.push_back(std::move(mark));
  }
  if (any_ellipse) entries.push_back(ellipse_entry());
  if (any_pose) {
    entries.push_back(start_entry());
    entries.push_back(end_entry());
  }
  return entries;
}

void TrajectoryMap::draw(Canvas& canvas, const Box& outer) const {
  const ChartFrame frame = map_frame(low_, high_, outer);
  frame.draw(canvas);
  canvas.clipped(frame.box(), [&] {
    for (const PlotSeries& series : plot_.series) draw_loops(canvas, frame, series);
    for (std::size_t i = 0; i < pens_.size(); ++i) {
      draw_line(canvas, frame, plot_.series[i], drawn_[i]);
    }
    for (const PlotSeries& series : plot_.series) {
      draw_ellipses(canvas, frame, series, plot_.max_ellipses);
    }
    const Placed at = [&](const Eigen::Vector2d& world) { return placed(frame, world); };
    for (const PlotSeries& series : plot_.series) draw_absolute(canvas, at, frame.box(), series);
    draw_ends(canvas, frame, plot_.series);
  });
}

}  // namespace fathom
