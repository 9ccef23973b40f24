#include "canvas.hpp"

#include <algorithm>
#include <cairo.h>
#include <numbers>
#include <optional>
#include <utility>

#include "fathom/core/utf8.hpp"
#include "text_layout.hpp"

namespace fathom {
namespace {

// Cairo's coordinates are fixed-point numbers below 2^23.
constexpr double kFarthest = 1e5;

void set_colour(cairo_t* context, Colour colour, double opacity) {
  cairo_set_source_rgba(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0,
                        opacity);
}

// The part of a segment that is not too far off the page (Liang and Barsky, 1984).
std::optional<std::pair<Eigen::Vector2d, Eigen::Vector2d>> near_part(const Eigen::Vector2d& from,
                                                                     const Eigen::Vector2d& to) {
  double first = 0.0;
  double last = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0.0) {
      if (std::abs(from[axis]) > kFarthest) return std::nullopt;
      continue;
    }
    const double low = (-kFarthest - from[axis]) / way;
    const double high = (kFarthest - from[axis]) / way;
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  if (first > last) return std::nullopt;
  return std::pair<Eigen::Vector2d, Eigen::Vector2d>(
      first == 0.0 ? from : from + first * (to - from),
      last == 1.0 ? to : from + last * (to - from));
}

// Of very many points those that lie apart as drawn: steps below a tenth of a point are not seen,
// and make large files.
std::vector<Eigen::Vector2d> visible_steps(std::span<const Eigen::Vector2d> points) {
  constexpr std::size_t kMany = 5000;
  constexpr double kUnseen = 0.1;
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_seen =
        kept.empty() || i + 1 == points.size() || !((points[i] - kept.back()).norm() < kUnseen);
    if (is_seen || points.size() <= kMany) kept.push_back(points[i]);
  }
  return kept;
}

void trace(cairo_t* context, std::span<const Eigen::Vector2d> points) {
  cairo_new_path(context);
  bool joined = false;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto part = near_part(points[i - 1], points[i]);
    if (!part) {
      joined = false;
      continue;
    }
    if (!joined) cairo_move_to(context, part->first.x(), part->first.y());
    cairo_line_to(context, part->second.x(), part->second.y());
    joined = part->second == points[i];
  }
}

Box ink_box(const std::string& text, const Eigen::Vector2d& start, const TextStyle& style) {
  const Box ink = text_ink(text, style.size);
  if (!style.upwards) return {start.x() + ink.left, start.y() + ink.top, ink.width, ink.height};
  return {start.x() + ink.top, start.y() - ink.right(), ink.height, ink.width};
}

}  // namespace

void Canvas::stroke(const Pen& pen) {
  set_colour(context_, pen.colour, pen.opacity);
  cairo_set_line_width(context_, pen.width);
  cairo_set_line_join(context_, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(context_, pen.dashes.data(), static_cast<int>(pen.dashes.size()), pen.dash_offset);
  cairo_stroke(context_);
}

void Canvas::line(std::span<const Eigen::Vector2d> points, const Pen& pen) {
  if (points.size() < 2) return;
  trace(context_, visible_steps(points));
  stroke(pen);
}

void Canvas::line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Pen& pen) {
  line(std::vector<Eigen::Vector2d>{from, to}, pen);
}

void Canvas::area(std::span<const Eigen::Vector2d> outline, Colour colour, double opacity) {
  if (outline.size() < 3) return;
  cairo_new_path(context_);
  for (const Eigen::Vector2d& corner : visible_steps(outline)) {
    cairo_line_to(context_, std::clamp(corner.x(), -kFarthest, kFarthest),
                  std::clamp(corner.y(), -kFarthest, kFarthest));
  }
  set_colour(context_, colour, opacity);
  cairo_fill(context_);
}

void Canvas::outline(std::vector<Eigen::Vector2d> corners, const Pen& pen) {
  if (corners.empty()) return;
  corners.push_back(corners.front());
  line(corners, pen);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius, Colour colour) {
  if (centre.cwiseAbs().maxCoeff() > kFarthest) return;
  cairo_new_path(context_);
  cairo_arc(context_, centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  set_colour(context_, colour, 1.0);
  cairo_fill(context_);
}

void Canvas::ring(const Eigen::Vector2d& centre, double radius, const Pen& pen) {
  if (centre.cwiseAbs().maxCoeff() > kFarthest) return;
  cairo_new_path(context_);
  cairo_arc(context_, centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  stroke(pen);
}

void Canvas::square(const Eigen::Vector2d& centre, double half, Colour colour) {
  if (centre.cwiseAbs().maxCoeff() > kFarthest) return;
  cairo_rectangle(context_, centre.x() - half, centre.y() - half, 2.0 * half, 2.0 * half);
  set_colour(context_, colour, 1.0);
  cairo_fill(context_);
}

void Canvas::text(const std::string& text, const Eigen::Vector2d& at, const TextStyle& style) {
  const std::string line = drawable_text(text);
  if (line.empty()) return;
  const double share = style.align == TextAlign::left     ? 0.0
                       : style.align == TextAlign::centre ? 0.5
                                                          : 1.0;
  const double shift = -share * text_width(line, style.size);
  const Eigen::Vector2d start = style.upwards ? Eigen::Vector2d(at.x(), at.y() - shift)
                                              : Eigen::Vector2d(at.x() + shift, at.y());
  cairo_save(context_);
  cairo_translate(context_, start.x(), start.y());
  if (style.upwards) cairo_rotate(context_, -std::numbers::pi / 2.0);
  set_chart_font(context_, style.size);
  cairo_move_to(context_, 0.0, 0.0);
  set_colour(context_, style.colour, 1.0);
  cairo_show_text(context_, line.c_str());
  cairo_restore(context_);
  texts_.push_back({line, ink_box(line, start, style)});
}

void Canvas::clipped(const Box& box, const std::function<void()>& draw) {
  cairo_save(context_);
  cairo_rectangle(context_, box.left, box.top, box.width, box.height);
  cairo_clip(context_);
  draw();
  cairo_restore(context_);
}

}  // namespace fathom
