#include "chart_frame.hpp"

#include <algorithm>
#include <cmath>

#include "text_layout.hpp"

namespace fathom {
namespace {

constexpr Colour kGrid{0xE4, 0xE6, 0xE8};
constexpr double kTick = 3.0;
constexpr double kLine = 1.25 * kFontSize;  // of text, with its descenders
constexpr double kGap = 3.0;                // between texts
constexpr double kRise = 0.35;  // times its size, from the middle of a digit to its baseline
constexpr double kWidestLabel = 90.0;

constexpr double kTallestLabel = 45.0;  // of one that stands on end
constexpr double kLead = 5.0;           // from a tick to such a label

double widest_of(const ChartAxis& axis) {
  double widest = 0.0;
  for (const auto& [value, text] : axis.ticks) {
    widest = std::max(widest, text_width(text, kFontSize));
  }
  return std::min(widest, kWidestLabel);
}

// The greatest size, down to 5 points, at which a title fits; then it is shortened.
struct FittedTitle {
  std::string text;
  double size = kFontSize;
};

FittedTitle fitted(const std::string& title, double most) {
  const double width = text_width(title, kFontSize);
  if (width <= most) return {title, kFontSize};
  const double size = std::max(5.0, kFontSize * most / width);
  return {shortened(title, size, most), size};
}

}  // namespace

ChartFrame::ChartFrame(ChartAxis x, ChartAxis y, const Box& outer)
    : x_(std::move(x)), y_(std::move(y)), outer_(outer) {
  const double left = kLine + kGap + widest_of(y_) + kTick + 1.0;
  const double above = 0.5 * kFontSize;
  // The last label of x stands half beyond its tick.
  const double last = x_.ticks.empty() ? 0.0 : 0.5 * text_width(x_.ticks.back().second, kFontSize);
  const double right = std::clamp(last, 2.0, 12.0);
  const auto set_box = [&] {
    const double below = kTick + label_height_ + kLine + 0.25 * kFontSize + 1.0;
    box_ = {outer.left + left, outer.top + above, std::max(1.0, outer.width - left - right),
            std::max(1.0, outer.height - above - below)};
  };
  set_box();
  is_turned_ = x_.keeps_labels && x_labels().size() < x_.ticks.size();
  if (!is_turned_) return;
  label_height_ = kLead + std::min(widest_of(x_), kTallestLabel) + 2.0;
  set_box();
}

ChartFrame ChartFrame::with_box(const Box& box) const {
  ChartFrame frame = *this;
  frame.box_ = box;
  return frame;
}

Eigen::Vector2d ChartFrame::at(double x, double y) const {
  return {box_.left + x_.share(x) * box_.width, box_.bottom() - y_.share(y) * box_.height};
}

std::vector<Eigen::Vector2d> ChartFrame::at(const std::vector<Eigen::Vector2d>& values) const {
  std::vector<Eigen::Vector2d> points;
  points.reserve(values.size());
  for (const Eigen::Vector2d& value : values) points.push_back(at(value.x(), value.y()));
  return points;
}

// A line of text apart, which is as small as their number asks for; moved from their ticks no more
// than that needs. Where all would be too small to read, every so many.
std::vector<ChartFrame::Label> ChartFrame::turned_labels() const {
  constexpr double kPitch = 1.1;
  constexpr double kSmallest = 4.0;
  const auto count = static_cast<double>(x_.ticks.size());
  const double every = std::ceil(count * kPitch * kSmallest / box_.width);
  std::vector<Label> all;
  for (const auto& [value, text] : x_.ticks) {
    const double tick = box_.left + x_.share(value) * box_.width;
    all.push_back({tick, text, kFontSize, tick});
  }
  std::ranges::sort(all, {}, &Label::at);
  std::vector<Label> labels;
  for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(every)) {
    labels.push_back(std::move(all[i]));
  }
  const double span = labels.back().at - labels.front().at;
  const double pitch = std::min(kPitch * kFontSize, span / static_cast<double>(labels.size() - 1));
  for (Label& label : labels) {
    label.size = pitch / kPitch;
    label.text = shortened(label.text, label.size, kTallestLabel);
  }
  for (std::size_t i = 1; i < labels.size(); ++i) {
    labels[i].at = std::max(labels[i].at, labels[i - 1].at + pitch);
  }
  double most = box_.right();
  for (std::size_t i = labels.size(); i-- > 0; most = labels[i].at - pitch) {
    labels[i].at = std::min(labels[i].at, most);
  }
  return labels;
}

// Kept on the page, and left out where a label would run into the one before. One that is wider
// than its share of the axis is shortened, so that its neighbours have room.
std::vector<ChartFrame::Label> ChartFrame::x_labels() const {
  std::vector<Label> from_left;
  for (const auto& [value, text] : x_.ticks) {
    from_left.push_back({box_.left + x_.share(value) * box_.width, text});
  }
  std::sort(from_left.begin(), from_left.end(),
            [](const Label& a, const Label& b) { return a.at < b.at; });
  const double share = box_.width / std::max<double>(1.0, static_cast<double>(from_left.size()));
  std::vector<Label> labels;
  double taken = outer_.left;
  for (Label& label : from_left) {
    label.text = shortened(label.text, kFontSize, std::max(share - kGap, 30.0));
    const double half = 0.5 * text_width(label.text, kFontSize);
    label.at = std::min(std::max(label.at, outer_.left + half), outer_.right() - half);
    if (label.at - half < taken) continue;
    taken = label.at + half + kGap;
    labels.push_back(std::move(label));
  }
  return labels;
}

std::vector<ChartFrame::Label> ChartFrame::y_labels() const {
  std::vector<Label> from_below;
  for (const auto& [value, text] : y_.ticks) {
    from_below.push_back(
        {box_.bottom() - y_.share(value) * box_.height, shortened(text, kFontSize, kWidestLabel)});
  }
  std::ranges::sort(from_below, std::ranges::greater(), &Label::at);
  double size = kFontSize;
  for (std::size_t i = 1; y_.keeps_labels && i < from_below.size(); ++i) {
    size = std::min(size, from_below[i - 1].at - from_below[i].at);
  }
  std::vector<Label> labels;
  for (Label& label : from_below) {
    if (!labels.empty() && label.at > labels.back().at - size) continue;
    label.size = size;
    labels.push_back(std::move(label));
  }
  return labels;
}

void ChartFrame::draw_x(Canvas& canvas) const {
  for (const auto& [value, text] : x_.ticks) {
    const double x = box_.left + x_.share(value) * box_.width;
    if (x_.grid) canvas.line({x, box_.top}, {x, box_.bottom()}, {kGrid, 0.5, {}, 1.0});
    canvas.line({x, box_.bottom()}, {x, box_.bottom() + kTick}, {kSoftInk, 0.7, {}, 1.0});
  }
  const double baseline = box_.bottom() + kTick + label_height_;
  for (const Label& label : is_turned_ ? turned_labels() : x_labels()) {
    if (is_turned_) {
      // From a value to its label, which may have had to move.
      const double top = box_.bottom() + kTick + kLead;
      canvas.line({label.tick, box_.bottom() + kTick}, {label.at, top}, {kSoftInk, 0.5, {}, 1.0});
      canvas.text(label.text, {label.at + kRise * label.size, top + 1.0},
                  {label.size, kSoftInk, TextAlign::right, true});
    } else {
      canvas.text(label.text, {label.at, baseline}, {label.size, kSoftInk, TextAlign::centre});
    }
  }
  const FittedTitle title = fitted(x_.title, outer_.width);
  const double half = 0.5 * text_width(title.text, title.size);
  const double middle = std::clamp(box_.middle().x(), outer_.left + half, outer_.right() - half);
  canvas.text(title.text, {middle, baseline + kLine},
              {title.size, palette::black, TextAlign::centre});
}

void ChartFrame::draw_y(Canvas& canvas) const {
  for (const auto& [value, text] : y_.ticks) {
    const double y = box_.bottom() - y_.share(value) * box_.height;
    canvas.line({box_.left, y}, {box_.right(), y}, {kGrid, 0.5, {}, 1.0});
  }
  for (const Label& label : y_labels()) {
    canvas.text(label.text, {box_.left - kTick, label.at + kRise * label.size},
                {label.size, kSoftInk, TextAlign::right});
  }
  const FittedTitle title = fitted(y_.title, outer_.height);
  const double half = 0.5 * text_width(title.text, title.size);
  const double middle = std::clamp(box_.middle().y(), outer_.top + half, outer_.bottom() - half);
  canvas.text(title.text, {outer_.left + kFontSize, middle},
              {title.size, palette::black, TextAlign::centre, true});
}

void ChartFrame::draw(Canvas& canvas) const {
  draw_y(canvas);
  draw_x(canvas);
  canvas.line(
      std::vector<Eigen::Vector2d>{
          {box_.left, box_.top}, {box_.left, box_.bottom()}, {box_.right(), box_.bottom()}},
      {kSoftInk, 0.7, {}, 1.0});
}

}  // namespace fathom
