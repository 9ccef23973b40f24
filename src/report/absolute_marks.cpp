#include "absolute_marks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fathom/geometry/covariance.hpp"
#include "map_frame.hpp"

namespace fathom {
namespace {

constexpr double kCrossHalf = 2.4;
constexpr double kHeadingLength = 7.0;
constexpr std::size_t kMostHeadings = 60;
constexpr double kTint = 0.2;

Pen pen_of(bool is_used) {
  return {
      is_used ? tint(palette::black, kTint) : palette::vermillion, is_used ? 0.5 : 0.9, {}, 1.0};
}

void draw_cross(Canvas& canvas, const Eigen::Vector2d& at, const Pen& pen) {
  for (const double sign : {-1.0, 1.0}) {
    const Eigen::Vector2d half(kCrossHalf, sign * kCrossHalf);
    canvas.line(at - half, at + half, pen);
  }
}

void draw_heading(Canvas& canvas, const Eigen::Vector2d& from, const Eigen::Vector2d& direction,
                  const Pen& pen) {
  canvas.line(from, from + kHeadingLength * direction.normalized(), pen);
}

LegendEntry entry(std::string text, bool is_heading, bool is_used) {
  return {std::move(text), [=](Canvas& canvas, const Eigen::Vector2d& centre) {
            const Pen pen = pen_of(is_used);
            if (is_heading) {
              const Eigen::Vector2d along(1.0, -0.4);
              draw_heading(canvas, centre - 0.5 * kHeadingLength * along, along, pen);
            } else {
              draw_cross(canvas, centre, pen);
            }
          }};
}

}  // namespace

AbsoluteMark absolute_mark(const AbsolutePose& z, bool is_used) {
  AbsoluteMark mark{z.keyframe, std::nullopt, std::nullopt, is_used};
  const Eigen::Matrix3d& W = z.information;
  if (W(0, 0) > 0.0 && W(1, 1) > 0.0) mark.position = z.pose.position();
  // A fix of a point beside the keyframe informs on its heading only together with its position.
  if (W(2, 2) > 0.0 && (!mark.position || rows_of(W).rank == 3)) mark.heading_rad = z.pose.theta;
  return mark;
}

void draw_absolute(Canvas& canvas, const Placed& placed, const PlotSeries& series) {
  const auto headings = static_cast<std::size_t>(std::ranges::count_if(
      series.absolute, [](const AbsoluteMark& m) { return m.is_used && m.heading_rad; }));
  const std::size_t every = std::max<std::size_t>(1, headings / kMostHeadings);
  std::size_t heading = 0;
  for (const AbsoluteMark& mark : series.absolute) {
    const Pose& pose = series.poses[mark.pose];
    if (!is_drawable(pose)) continue;
    const Eigen::Vector2d at = placed(pose.position());
    const Pen pen = pen_of(mark.is_used);
    if (mark.position && is_drawable({mark.position->x(), mark.position->y(), 0.0})) {
      const Eigen::Vector2d fix = placed(*mark.position);
      canvas.line(at, fix, {pen.colour, 0.3, {}, 1.0});
      draw_cross(canvas, fix, pen);
    }
    if (!mark.heading_rad) continue;
    if (mark.is_used && heading++ % every != 0) continue;
    const Eigen::Vector2d ahead(std::cos(*mark.heading_rad), std::sin(*mark.heading_rad));
    draw_heading(canvas, at, placed(pose.position() + ahead) - at, pen);
  }
}

std::vector<LegendEntry> absolute_legend(const std::vector<PlotSeries>& all) {
  bool has[2][2] = {};
  for (const PlotSeries& series : all) {
    for (const AbsoluteMark& mark : series.absolute) {
      if (mark.position) has[0][mark.is_used ? 0 : 1] = true;
      if (mark.heading_rad) has[1][mark.is_used ? 0 : 1] = true;
    }
  }
  std::vector<LegendEntry> entries;
  if (has[0][0]) entries.push_back(entry("fix", false, true));
  if (has[0][1]) entries.push_back(entry("fix not used", false, false));
  if (has[1][0]) entries.push_back(entry("measured heading", true, true));
  if (has[1][1]) entries.push_back(entry("heading not used", true, false));
  return entries;
}

}  // namespace fathom
