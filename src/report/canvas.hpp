#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/report/palette.hpp"

namespace fathom {

enum class TextAnchor { left, centre, right };

/// A rectangle in pixels of the finished picture.
struct PixelBox {
  double left = 0.0;
  double top = 0.0;
  double right = 0.0;
  double bottom = 0.0;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

struct Stroke {
  Colour colour;
  double width_px = 1.0;
  double dash_px = 0.0;  ///< length of dashes and gaps; 0: solid
};

/// A white picture to draw on. All coordinates are pixels of the finished picture, u right and v
/// down; it is drawn at twice the size and averaged down, which makes OpenCV's stroke fonts fair.
class Canvas {
 public:
  Canvas(int width_px, int height_px);

  /// Restricts all drawing to a box, or to the whole picture again.
  void clip_to(const PixelBox& box);
  void clip_to_all();

  void line(const std::vector<Eigen::Vector2d>& points, const Stroke& stroke);
  void closed_line(std::vector<Eigen::Vector2d> points, const Stroke& stroke);
  void disc(const Eigen::Vector2d& centre, double radius_px, Colour fill);
  void ring(const Eigen::Vector2d& centre, double radius_px, const Stroke& stroke);
  void square(const Eigen::Vector2d& centre, double half_px, Colour fill);
  void image(const cv::Mat& bgr, const Eigen::Vector2d& top_left);

  /// ASCII; other characters are drawn as '?'. `at` is on the baseline.
  void text(const std::string& text, const Eigen::Vector2d& at, double height_px,
            TextAnchor anchor = TextAnchor::left, Colour colour = palette::black);
  static double text_width_px(const std::string& text, double height_px);
  /// The height at which the text is no wider than it may be: `height_px`, or less.
  static double fitting_height_px(const std::string& text, double height_px, double widest_px);

  /// The picture, 8-bit BGR.
  cv::Mat finish() const;

 private:
  cv::Point fixed_point(const Eigen::Vector2d& point) const;

  cv::Mat large_;
  cv::Rect clip_;
};

}  // namespace fathom
