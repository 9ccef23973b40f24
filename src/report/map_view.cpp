#include "map_view.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace fathom {
namespace {

constexpr Colour kGridColour{0xE2, 0xE2, 0xE2};
constexpr Colour kFrameColour{0x70, 0x70, 0x70};
constexpr double kLabelHeight = 15.0;

std::vector<double> multiples(double low, double high, double step) {
  std::vector<double> values;
  for (double i = std::ceil(low / step); i * step <= high; i += 1.0) {
    values.push_back(i == 0.0 ? 0.0 : i * step);  // no −0
  }
  return values;
}

}  // namespace

double round_step(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

std::string coordinate_text(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 9);
  char buffer[48];
  if (step >= 1e6) {
    std::snprintf(buffer, sizeof buffer, "%g", value);
  } else {
    std::snprintf(buffer, sizeof buffer, "%.*f", decimals, value);
  }
  return buffer;
}

MapView::MapView(const std::vector<Eigen::Vector2d>& points, const PixelBox& frame)
    : frame_(frame) {
  Eigen::Vector2d low(-1.0, -1.0);
  Eigen::Vector2d high(1.0, 1.0);
  if (!points.empty()) low = high = points.front();
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  centre_ = 0.5 * (low + high);
  Eigen::Vector2d extent = high - low;
  // All at one place: a metre round it, or what its coordinates still tell apart.
  const double least = 1e-9 * std::max(1.0, centre_.cwiseAbs().maxCoeff());
  if (extent.maxCoeff() < least) extent.setConstant(std::max(1.0, least));
  extent = extent.cwiseMax(least);
  constexpr double kMargin = 1.12;
  pixels_per_metre_ =
      std::min(frame.height() / (kMargin * extent.x()), frame.width() / (kMargin * extent.y()));
}

Eigen::Vector2d MapView::pixel(const Eigen::Vector2d& world) const {
  return {0.5 * (frame_.left + frame_.right) - (world.y() - centre_.y()) * pixels_per_metre_,
          0.5 * (frame_.top + frame_.bottom) - (world.x() - centre_.x()) * pixels_per_metre_};
}

MapView::Span MapView::x_span() const {
  const double half = 0.5 * frame_.height() / pixels_per_metre_;
  return {centre_.x() - half, centre_.x() + half};
}

MapView::Span MapView::y_span() const {
  const double half = 0.5 * frame_.width() / pixels_per_metre_;
  return {centre_.y() - half, centre_.y() + half};
}

// Steps are wide enough for the labels of the y axis, which stand side by side.
double MapView::grid_step() const {
  constexpr double kLeastSpacing = 110.0;
  const double step = round_step(kLeastSpacing / pixels_per_metre_);
  const Span y = y_span();
  const double widest =
      std::max(Canvas::text_width_px(coordinate_text(y.low, step), kLabelHeight),
               Canvas::text_width_px(coordinate_text(y.high, step), kLabelHeight));
  return std::max(step, round_step((widest + 24.0) / pixels_per_metre_));
}

double MapView::label_width_px() const {
  const Span x = x_span();
  const double step = grid_step();
  double widest = 0.0;
  for (const double value : multiples(x.low, x.high, step)) {
    widest = std::max(widest, Canvas::text_width_px(coordinate_text(value, step), kLabelHeight));
  }
  return widest;
}

void MapView::draw_grid(Canvas& canvas) const {
  const double step = grid_step();
  const Span y = y_span();
  const Span x = x_span();
  for (const double value : multiples(x.low, x.high, step)) {
    const double v = pixel({value, centre_.y()}).y();
    canvas.line({{frame_.left, v}, {frame_.right, v}}, {kGridColour, 1.0});
    canvas.text(coordinate_text(value, step), {frame_.left - 10, v + 6}, kLabelHeight,
                TextAnchor::right);
  }
  for (const double value : multiples(y.low, y.high, step)) {
    const double u = pixel({centre_.x(), value}).x();
    canvas.line({{u, frame_.top}, {u, frame_.bottom}}, {kGridColour, 1.0});
    canvas.text(coordinate_text(value, step), {u, frame_.bottom + 26}, kLabelHeight,
                TextAnchor::centre);
  }
  canvas.closed_line({{frame_.left, frame_.top},
                      {frame_.right, frame_.top},
                      {frame_.right, frame_.bottom},
                      {frame_.left, frame_.bottom}},
                     {kFrameColour, 1.0});
  canvas.text("x (m), up", {frame_.left, frame_.top - 12}, kLabelHeight);
  canvas.text("y (m), to the left", {frame_.right, frame_.bottom + 52}, kLabelHeight,
              TextAnchor::right);
}

}  // namespace fathom
