#include "plot_legend.hpp"

#include <utility>

namespace fathom {
namespace {

constexpr double kTextHeight = 16.0;
constexpr double kRowHeight = 32.0;
constexpr double kSampleWidth = 48.0;
constexpr double kGap = 36.0;

}  // namespace

PlotLegend::PlotLegend(std::vector<LegendEntry> entries, double left_px, double right_px)
    : entries_(std::move(entries)) {
  double left = left_px;
  for (const LegendEntry& entry : entries_) {
    const double width = kSampleWidth + 10 + Canvas::text_width_px(entry.text, kTextHeight);
    if (rows_ == 0) rows_ = 1;
    if (left > left_px && left + width > right_px) {
      left = left_px;
      ++rows_;
    }
    places_.push_back({left, rows_ - 1});
    left += width + kGap;
  }
}

double PlotLegend::height_px() const {
  return rows_ * kRowHeight;
}

void PlotLegend::draw(Canvas& canvas, double top_px) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const double middle = top_px + (places_[i].row + 0.5) * kRowHeight;
    entries_[i].sample(canvas, {places_[i].left_px + kSampleWidth / 2, middle});
    canvas.text(entries_[i].text,
                {places_[i].left_px + kSampleWidth + 10, middle + kTextHeight / 2}, kTextHeight);
  }
}

}  // namespace fathom
