#include "chart_frame.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/report/table.hpp"
#include "map_view.hpp"

namespace fathom {
namespace {

constexpr Colour kGrid{0xE4, 0xE6, 0xE8};
constexpr double kTick = 3.0;
constexpr double kRoomRight = 8.0;  // beside the axes, for half a label

void add_round_ticks(ChartAxis& axis) {
  const double step = round_step((axis.high - axis.low) / 7.0);
  // So far from zero that no label would tell two ticks apart.
  if (std::max(std::abs(axis.low), std::abs(axis.high)) / step > 1e9) return;
  const auto first = static_cast<long>(std::ceil(axis.low / step - 1e-9));
  const auto last = static_cast<long>(std::floor(axis.high / step + 1e-9));
  for (long i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step;
    axis.ticks.emplace_back(value, coordinate_text(value, step));
  }
}

// "0.5", "20", "1e+07": 1, 2 and 5 times powers of ten have one digit.
std::string round_text(double value) {
  const int digits = value >= 1.0 ? static_cast<int>(std::floor(std::log10(value) + 1e-9)) + 1 : 1;
  return format_number(value, digits);
}

void add_logarithmic_ticks(ChartAxis& axis) {
  const double decades = std::log10(axis.high / axis.low);
  for (int power = static_cast<int>(std::floor(std::log10(axis.low))) - 1;
       std::pow(10.0, power) <= axis.high * 1.001; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, power);
      const bool inside = value >= axis.low * 0.999 && value <= axis.high * 1.001;
      if (inside && (factor == 1.0 || decades < 2.5))
        axis.ticks.emplace_back(value, round_text(value));
    }
  }
}

// The greatest of 1, 2 and 5 times a power of ten that is at most the value.
double rounded_down(double value) {
  const double ten = std::pow(10.0, std::floor(std::log10(value)));
  return value >= 5.0 * ten ? 5.0 * ten : value >= 2.0 * ten ? 2.0 * ten : ten;
}

}  // namespace

double ChartAxis::share(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
}

ChartAxis axis_over(std::string title, const std::vector<double>& values, bool from_zero) {
  ChartAxis axis;
  axis.title = std::move(title);
  if (!values.empty()) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    axis.low = from_zero ? std::min(0.0, *least) : *least;
    axis.high = from_zero ? std::max(0.0, *most) : *most;
  }
  if (!(axis.high > axis.low)) axis.high = axis.low + std::max(1.0, std::abs(axis.low));
  if (from_zero) axis.high += 0.04 * (axis.high - axis.low);
  add_round_ticks(axis);
  return axis;
}

ChartAxis logarithmic_axis_over(std::string title, const std::vector<double>& values) {
  ChartAxis axis;
  axis.title = std::move(title);
  axis.logarithmic = true;
  std::vector<double> positive;
  std::copy_if(values.begin(), values.end(), std::back_inserter(positive),
               [](double value) { return value > 0.0; });
  if (positive.empty()) positive = {1.0};
  const auto [least, most] = std::minmax_element(positive.begin(), positive.end());
  axis.low = rounded_down(*least);
  axis.high = 1.0 / rounded_down(1.0 / *most);
  if (!(axis.high > axis.low)) axis.high = 10.0 * axis.low;
  add_logarithmic_ticks(axis);
  return axis;
}

ChartFrame::ChartFrame(ChartAxis x, ChartAxis y, const Box& box)
    : x_(std::move(x)), y_(std::move(y)), box_(box) {}

Eigen::Vector2d ChartFrame::at(double x, double y) const {
  return {box_.left + x_.share(x) * box_.width, box_.bottom() - y_.share(y) * box_.height};
}

// A label is kept on the page, and left out where it would run into the one before.
void ChartFrame::draw_x_ticks(VectorCanvas& canvas, const Pen& pen) const {
  std::vector<std::pair<double, std::string>> from_left;
  for (const auto& [value, text] : x_.ticks) {
    from_left.emplace_back(box_.left + x_.share(value) * box_.width, text);
  }
  std::sort(from_left.begin(), from_left.end());
  double taken = 0.0;
  for (const auto& [x, text] : from_left) {
    canvas.line(std::vector<Eigen::Vector2d>{{x, box_.bottom()}, {x, box_.bottom() + kTick}}, pen);
    const double half = 0.5 * canvas.text_width(text, kFontSize);
    const double middle = std::min(x, box_.right() + kRoomRight - half);
    if (middle - half < taken) continue;
    canvas.text(text, {middle, box_.bottom() + kTick + kFontSize}, kFontSize, kSoftInk,
                TextAlign::centre);
    taken = middle + half + 3.0;
  }
}

void ChartFrame::draw(VectorCanvas& canvas) const {
  const Pen grid{kGrid, 0.5, {}, 1.0};
  const Pen frame{kSoftInk, 0.7, {}, 1.0};
  for (const auto& [value, text] : y_.ticks) {
    const double y = box_.bottom() - y_.share(value) * box_.height;
    canvas.line(std::vector<Eigen::Vector2d>{{box_.left, y}, {box_.right(), y}}, grid);
    canvas.text(text, {box_.left - kTick, y + 0.35 * kFontSize}, kFontSize, kSoftInk,
                TextAlign::right);
  }
  draw_x_ticks(canvas, frame);
  canvas.line(
      std::vector<Eigen::Vector2d>{
          {box_.left, box_.top}, {box_.left, box_.bottom()}, {box_.right(), box_.bottom()}},
      frame);
  canvas.text(x_.title, {box_.left + box_.width / 2.0, box_.bottom() + 2.8 * kFontSize}, kFontSize,
              palette::black, TextAlign::centre);
  canvas.text(y_.title, {box_.left - 28.0, box_.top + box_.height / 2.0}, kFontSize, palette::black,
              TextAlign::centre, true);
}

double draw_figure_legend(VectorCanvas& canvas, const std::vector<FigureLegendEntry>& entries,
                          const Eigen::Vector2d& top_left, double width) {
  constexpr double kSample = 16.0;
  constexpr double kRow = 1.45 * kFontSize;
  double x = top_left.x();
  double y = top_left.y() + kFontSize;
  for (const FigureLegendEntry& entry : entries) {
    const double needed = kSample + 4.0 + canvas.text_width(entry.text, kFontSize) + 10.0;
    if (x > top_left.x() && x + needed > top_left.x() + width) {
      x = top_left.x();
      y += kRow;
    }
    const double middle = y - 0.35 * kFontSize;
    canvas.line(std::vector<Eigen::Vector2d>{{x, middle}, {x + kSample, middle}}, entry.pen);
    canvas.text(entry.text, {x + kSample + 4.0, y}, kFontSize, palette::black);
    x += needed;
  }
  return y + 0.5 * kRow - top_left.y();
}

Pen pen_of(const LineStyle& style, double width) {
  Pen pen{style.colour, width, {}, 1.0};
  if (style.dashed) pen.dashes = {4.0, 2.0};
  return pen;
}

}  // namespace fathom
