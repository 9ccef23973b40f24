#include "absolute_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "keyframe_series.hpp"
#include "map_frame.hpp"

namespace fathom {
namespace {

using Point = Eigen::Vector2d;

constexpr double kRingRadius = 1.7;
constexpr double kCrossHalf = 2.4;
constexpr double kHeadingLength = 8.0;
constexpr double kLeftOutLength = 10.0;
constexpr double kBarHalf = 1.8;
constexpr double kArrowLength = 5.0;
constexpr double kArrowHalf = 2.2;
constexpr double kTint = 0.55;
constexpr double kNeedleTint = 0.85;  // of headings, which lie on the line of their trajectory

Pen pen_of(bool is_kept) {
  return {is_kept ? tint(palette::black, kTint) : palette::crimson, is_kept ? 0.6 : 1.0, {}, 1.0};
}

Pen link_pen_of(bool is_kept) {
  Pen pen = pen_of(is_kept);
  pen.width = is_kept ? 0.35 : 0.5;
  if (!is_kept) pen.dashes = {2.5, 1.5};
  return pen;
}

void draw_fix(Canvas& canvas, const Point& at, bool is_kept) {
  const Pen pen = pen_of(is_kept);
  if (is_kept) return canvas.ring(at, kRingRadius, pen);
  for (const double sign : {-1.0, 1.0}) {
    const Point half(kCrossHalf, sign * kCrossHalf);
    canvas.line(at - half, at + half, pen);
  }
}

// `direction` on the page, of length 1.
void draw_heading(Canvas& canvas, const Point& from, const Point& direction, bool is_kept) {
  Pen pen = pen_of(is_kept);
  if (is_kept) pen.colour = tint(palette::black, kNeedleTint);
  const Point tip = from + (is_kept ? kHeadingLength : kLeftOutLength) * direction;
  canvas.line(from, tip, pen);
  if (is_kept) return;
  const Point half = kBarHalf * Point(-direction.y(), direction.x());
  canvas.line(tip - half, tip + half, pen);
}

// An arrow head with its tip at the edge of the frame, where the way from `from`, within it, to
// `to` leaves; nothing where it does not.
void draw_exit(Canvas& canvas, const Box& frame, const Point& from, const Point& to, bool is_kept) {
  const Point low(frame.left, frame.top);
  const Point high(frame.right(), frame.bottom());
  const auto is_within = [&](const Point& at) {
    return (at.array() >= low.array()).all() && (at.array() <= high.array()).all();
  };
  if (!is_within(from) || is_within(to)) return;
  double share = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double edge = to[axis] < from[axis] ? low[axis] : high[axis];
    if (to[axis] != from[axis]) {
      const double at_edge = (edge - from[axis]) / (to[axis] - from[axis]);
      if (at_edge >= 0.0) share = std::min(share, at_edge);
    }
  }
  const Point ahead = (to - from).normalized();
  const Point tip = from + share * (to - from);
  const Point half = kArrowHalf * Point(-ahead.y(), ahead.x());
  const Point base = tip - kArrowLength * ahead;
  canvas.area(std::array{tip, Point(base + half), Point(base - half)}, pen_of(is_kept).colour);
}

enum Kind { fix, heading };

struct MarkCount {
  std::size_t drawn = 0;
  std::size_t all = 0;
};

// By kind, and whether it was left out.
using Counts = std::array<std::array<MarkCount, 2>, 2>;

void count(const PlotSeries& series, Counts& counts) {
  const auto add = [&](const AbsoluteMark& mark, std::size_t MarkCount::*number) {
    const std::size_t left_out = mark.is_kept ? 0 : 1;
    if (mark.measured.position) ++(counts[fix][left_out].*number);
    if (mark.measured.heading_rad) ++(counts[heading][left_out].*number);
  };
  for (const AbsoluteMark& mark : series.absolute) add(mark, &MarkCount::all);
  for (const std::size_t i : drawn_marks(series.absolute))
    add(series.absolute[i], &MarkCount::drawn);
}

LegendEntry entry(std::string text, const MarkCount& count, Kind kind, bool is_kept) {
  if (count.drawn < count.all) {
    text += fmt::format(" ({} of {})", count.drawn, count.all);
  }
  return {std::move(text), [=](Canvas& canvas, const Point& centre) {
            if (kind == fix) return draw_fix(canvas, centre, is_kept);
            const Point along = Point(1.0, -0.4).normalized();
            draw_heading(canvas, centre - 0.5 * kHeadingLength * along, along, is_kept);
          }};
}

bool leaves(const std::vector<PlotSeries>& all, const Eigen::AlignedBox2d& shown) {
  return std::ranges::any_of(all, [&shown](const PlotSeries& series) {
    return std::ranges::any_of(series.absolute, [&shown](const AbsoluteMark& mark) {
      return mark.measured.position && !shown.contains(*mark.measured.position);
    });
  });
}

// `at` is its pose on the page.
void draw_mark(Canvas& canvas, const Placed& placed, const Box& frame, const AbsoluteMark& mark,
               const Point& at) {
  const auto& position = mark.measured.position;
  if (position && is_drawable({position->x(), position->y(), 0.0})) {
    const Point where = placed(*position);
    canvas.line(at, where, link_pen_of(mark.is_kept));
    draw_fix(canvas, where, mark.is_kept);
    draw_exit(canvas, frame, at, where, mark.is_kept);
  }
  const auto& heading_rad = mark.measured.heading_rad;
  if (!heading_rad || !std::isfinite(*heading_rad)) return;
  // x is up and y to the left.
  draw_heading(canvas, at, {-std::sin(*heading_rad), -std::cos(*heading_rad)}, mark.is_kept);
}

}  // namespace

AbsoluteMark absolute_mark(const AbsolutePose& z, bool is_kept) {
  return {z.keyframe, parts_of(z), is_kept};
}

void keep_one_set_of_marks(std::vector<PlotSeries>& series) {
  const auto has_any = [](const PlotSeries& one) { return !one.absolute.empty(); };
  const auto left_out = [](const PlotSeries& one) {
    return std::ranges::any_of(one.absolute, [](const AbsoluteMark& m) { return !m.is_kept; });
  };
  auto shown = std::ranges::find_if(series, left_out);
  if (shown == series.end()) shown = std::ranges::find_if(series, has_any);
  for (auto one = series.begin(); one != series.end(); ++one) {
    if (one != shown) one->absolute.clear();
  }
  if (shown != series.end()) shown->absolute_of = shown->name;
}

MarkLimits MarkLimits::within(std::size_t most) const {
  const std::size_t all = fixes + headings + left_out;
  if (most >= all) return *this;
  return {fixes * most / all, headings * most / all, left_out * most / all};
}

std::vector<std::size_t> drawn_marks(const std::vector<AbsoluteMark>& marks,
                                     const MarkLimits& limits) {
  std::vector<std::size_t> left_out;
  std::vector<std::size_t> fixes;
  std::vector<std::size_t> headings;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!marks[i].is_kept) {
      left_out.push_back(i);
    } else if (marks[i].measured.position) {
      fixes.push_back(i);
    } else if (marks[i].measured.heading_rad) {
      headings.push_back(i);
    }
  }
  std::vector<std::size_t> drawn = picked(left_out, thinned(left_out.size(), limits.left_out));
  for (const auto& [places, most] :
       {std::pair(&fixes, limits.fixes), std::pair(&headings, limits.headings)}) {
    const auto some = picked(*places, thinned(places->size(), most));
    drawn.insert(drawn.end(), some.begin(), some.end());
  }
  std::ranges::sort(drawn);
  return drawn;
}

Eigen::AlignedBox2d with_fixes(const Eigen::AlignedBox2d& poses,
                               const std::vector<PlotSeries>& all) {
  if (poses.isEmpty()) return poses;
  constexpr double kRoom = 0.25;
  const Point room = Point::Constant(kRoom * poses.sizes().maxCoeff());
  const Eigen::AlignedBox2d most(poses.min() - room, poses.max() + room);
  Eigen::AlignedBox2d shown = poses;
  for (const PlotSeries& series : all) {
    for (const AbsoluteMark& mark : series.absolute) {
      const auto& position = mark.measured.position;
      if (position && most.contains(*position)) shown.extend(*position);
    }
  }
  return shown;
}

void draw_absolute(Canvas& canvas, const Placed& placed, const Box& frame,
                   const PlotSeries& series) {
  const std::vector<std::size_t> drawn = drawn_marks(series.absolute);
  // What was left out lies on top.
  for (const bool is_kept : {true, false}) {
    for (const std::size_t i : drawn) {
      const AbsoluteMark& mark = series.absolute[i];
      const Pose& pose = series.poses[mark.pose];
      if (mark.is_kept == is_kept && is_drawable(pose)) {
        draw_mark(canvas, placed, frame, mark, placed(pose.position()));
      }
    }
  }
}

std::vector<LegendEntry> absolute_legend(const std::vector<PlotSeries>& all,
                                         const Eigen::AlignedBox2d& shown) {
  Counts counts;
  std::string by;
  for (const PlotSeries& series : all) {
    count(series, counts);
    if (!series.absolute_of.empty()) by = " by " + series.absolute_of;
  }
  const std::string beyond = leaves(all, shown) ? ", an arrow if beyond the map" : "";
  const std::array<std::array<std::string, 2>, 2> texts{
      {{"fix", "fix left out" + by + beyond}, {"measured heading", "heading left out" + by}}};
  std::vector<LegendEntry> entries;
  for (const Kind kind : {fix, heading}) {
    for (const int is_left_out : {0, 1}) {
      const MarkCount& of = counts[kind][is_left_out];
      if (of.all > 0) entries.push_back(entry(texts[kind][is_left_out], of, kind, !is_left_out));
    }
  }
  return entries;
}

}  // namespace fathom
