#include "canvas.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

constexpr int kScale = 2;
constexpr int kShift = 4;  // sub-pixel bits of OpenCV's fixed-point coordinates
constexpr int kFont = cv::FONT_HERSHEY_DUPLEX;
// Capital letters of this font are 21 units high at scale 1.
constexpr double kFontUnits = 21.0;

cv::Scalar bgr(Colour colour) {
  return {double(colour.blue), double(colour.green), double(colour.red)};
}

int thickness(double width_px) {
  return std::max(1, static_cast<int>(std::lround(width_px * kScale)));
}

std::string ascii(const std::string& text) {
  std::string plain;
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if ((byte & 0xC0) == 0x80) continue;  // the rest of a UTF-8 character
    plain += byte >= 0x20 && byte < 0x7f ? letter : '?';
  }
  return plain;
}

// The pieces of a line that are dashes, the pattern carried on across its corners.
std::vector<std::vector<Eigen::Vector2d>> dashes_of(const std::vector<Eigen::Vector2d>& points,
                                                    double dash_px) {
  std::vector<std::vector<Eigen::Vector2d>> dashes{{points.front()}};
  bool drawing = true;
  double left_px = dash_px;
  for (std::size_t i = 1; i < points.size(); ++i) {
    Eigen::Vector2d from = points[i - 1];
    double length_px = (points[i] - from).norm();
    while (length_px > left_px) {
      from += (points[i] - from) * (left_px / length_px);
      length_px -= left_px;
      left_px = dash_px;
      if (drawing) dashes.back().push_back(from);
      if (!drawing) dashes.push_back({from});
      drawing = !drawing;
    }
    left_px -= length_px;
    if (drawing) dashes.back().push_back(points[i]);
  }
  return dashes;
}

}  // namespace

Canvas::Canvas(int width_px, int height_px)
    : large_(height_px * kScale, width_px * kScale, CV_8UC3, cv::Scalar::all(255)) {
  clip_to_all();
}

void Canvas::clip_to(const PixelBox& box) {
  const auto scaled = [](double value) { return static_cast<int>(std::lround(value * kScale)); };
  const cv::Rect wanted(scaled(box.left), scaled(box.top), scaled(box.width()),
                        scaled(box.height()));
  clip_ = wanted & cv::Rect({0, 0}, large_.size());
}

void Canvas::clip_to_all() {
  clip_ = cv::Rect({0, 0}, large_.size());
}

// OpenCV clips at the border of the matrix it draws on, but its fixed-point coordinates must not
// overflow: what is far outside stays far outside.
cv::Point Canvas::fixed_point(const Eigen::Vector2d& point) const {
  static constexpr double kFar = 1 << 20;
  const auto fixed = [](double value, int offset) {
    const double pixel = std::clamp(kScale * (value + 0.5) - 0.5 - offset, -kFar, kFar);
    return static_cast<int>(std::lround(pixel * (1 << kShift)));
  };
  return {fixed(point.x(), clip_.x), fixed(point.y(), clip_.y)};
}

void Canvas::line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke) {
  if (points.empty()) return;
  cv::Mat target = large_(clip_);
  std::vector<std::vector<Eigen::Vector2d>> pieces{points};
  if (stroke.dash_px > 0.0) pieces = dashes_of(points, stroke.dash_px);
  for (const std::vector<Eigen::Vector2d>& piece : pieces) {
    std::vector<cv::Point> fixed;
    fixed.reserve(piece.size());
    for (const Eigen::Vector2d& point : piece) fixed.push_back(fixed_point(point));
    cv::polylines(target, fixed, false, bgr(stroke.colour), thickness(stroke.width_px), cv::LINE_AA,
                  kShift);
  }
}

void Canvas::closed_line(std::vector<Eigen::Vector2d> points, const Stroke& stroke) {
  if (points.empty()) return;
  points.push_back(points.front());
  line(points, stroke);
}

void Canvas::disc(const Eigen::Vector2d& centre, double radius_px, Colour fill) {
  cv::Mat target = large_(clip_);
  const int radius = static_cast<int>(std::lround(radius_px * kScale * (1 << kShift)));
  cv::circle(target, fixed_point(centre), radius, bgr(fill), cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::ring(const Eigen::Vector2d& centre, double radius_px, const Stroke& stroke) {
  cv::Mat target = large_(clip_);
  const int radius = static_cast<int>(std::lround(radius_px * kScale * (1 << kShift)));
  cv::circle(target, fixed_point(centre), radius, bgr(stroke.colour), thickness(stroke.width_px),
             cv::LINE_AA, kShift);
}

void Canvas::square(const Eigen::Vector2d& centre, double half_px, Colour fill) {
  cv::Mat target = large_(clip_);
  const Eigen::Vector2d half(half_px, half_px);
  cv::rectangle(target, fixed_point(centre - half), fixed_point(centre + half), bgr(fill),
                cv::FILLED, cv::LINE_AA, kShift);
}

void Canvas::image(const cv::Mat& picture, const Eigen::Vector2d& top_left) {
  const cv::Rect place(static_cast<int>(std::lround(top_left.x())) * kScale,
                       static_cast<int>(std::lround(top_left.y())) * kScale, picture.cols * kScale,
                       picture.rows * kScale);
  cv::Mat target = large_(place);
  cv::resize(picture, target, place.size(), 0, 0, cv::INTER_NEAREST);
}

void Canvas::text(const std::string& text, const Eigen::Vector2d& at, double height_px,
                  TextAnchor anchor, Colour colour) {
  const double width_px = text_width_px(text, height_px);
  const double shift_px = anchor == TextAnchor::left     ? 0.0
                          : anchor == TextAnchor::centre ? width_px / 2
                                                         : width_px;
  const cv::Point origin(static_cast<int>(std::lround((at.x() - shift_px) * kScale)) - clip_.x,
                         static_cast<int>(std::lround(at.y() * kScale)) - clip_.y);
  cv::Mat target = large_(clip_);
  cv::putText(target, ascii(text), origin, kFont, height_px * kScale / kFontUnits, bgr(colour),
              thickness(height_px / 14.0), cv::LINE_AA);
}

double Canvas::text_width_px(const std::string& text, double height_px) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(ascii(text), kFont, height_px * kScale / kFontUnits,
                                        thickness(height_px / 14.0), &baseline);
  return size.width / double{kScale};
}

double Canvas::fitting_height_px(const std::string& text, double height_px, double widest_px) {
  const double width_px = text_width_px(text, height_px);
  return width_px <= widest_px ? height_px : height_px * widest_px / width_px;
}

cv::Mat Canvas::finish() const {
  cv::Mat picture;
  cv::resize(large_, picture, large_.size() / kScale, 0, 0, cv::INTER_AREA);
  return picture;
}

}  // namespace fathom
