#include "chart_legend.hpp"

#include <utility>

#include "chart_frame.hpp"
#include "study_styles.hpp"
#include "text_layout.hpp"

namespace fathom {
namespace {

constexpr double kRow = 1.45 * kFontSize;
constexpr double kSample = 16.0;
constexpr double kEntryGap = 4.0;
constexpr double kBetweenEntries = 10.0;

}  // namespace

LegendEntry line_entry(const std::string& text, const Pen& pen) {
  return {text, [pen](Canvas& canvas, const Eigen::Vector2d& centre) {
            const Eigen::Vector2d half(0.5 * kSample, 0.0);
            canvas.line(centre - half, centre + half, pen);
          }};
}

LegendEntry disc_entry(const std::string& text, Colour colour) {
  return {text, [colour](Canvas& canvas, const Eigen::Vector2d& centre) {
            canvas.disc(centre, 3.0, colour);
          }};
}

LegendEntry mark_entry(const std::string& text, const LineStyle& style) {
  return {text, [style](Canvas& canvas, const Eigen::Vector2d& centre) {
            draw_mark(canvas, centre, style);
          }};
}

ChartLegend::ChartLegend(std::vector<LegendEntry> entries, double width)
    : entries_(std::move(entries)) {
  double left = 0.0;
  for (LegendEntry& entry : entries_) {
    entry.text = shortened(entry.text, kFontSize, width - kSample - kEntryGap);
    const double needed = kSample + kEntryGap + text_width(entry.text, kFontSize);
    if (rows_ == 0) rows_ = 1;
    if (left > 0.0 && left + needed > width) {
      left = 0.0;
      ++rows_;
    }
    places_.push_back({left, rows_ - 1});
    left += needed + kBetweenEntries;
  }
}

double ChartLegend::height() const {
  return rows_ * kRow;
}

void ChartLegend::draw(Canvas& canvas, const Eigen::Vector2d& top_left) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double left = top_left.x() + places_[i].left;
    const double baseline = top_left.y() + places_[i].row * kRow + kFontSize;
    entries_[i].sample(canvas, {left + 0.5 * kSample, baseline - 0.35 * kFontSize});
    canvas.text(entries_[i].text, {left + kSample + kEntryGap, baseline}, {.size = kFontSize});
  }
}

}  // namespace fathom
