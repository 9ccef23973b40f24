#pragma once

#include "canvas.hpp"
#include "chart_axis.hpp"

namespace fathom {

inline constexpr double kFontSize = 7.5;
inline constexpr Colour kSoftInk{0x55, 0x5B, 0x61};

/// The axes of a chart with its grid, and the way from values to points of the page. Its texts are
/// measured: no label runs into another one or into a title, and none leaves the outer box. Those
/// of x that are to be kept stand on end where they have no room side by side.
class ChartFrame {
 public:
  /// Axes, labels and titles together fill `outer`.
  ChartFrame(ChartAxis x, ChartAxis y, const Box& outer);

  void draw(Canvas& canvas) const;
  Eigen::Vector2d at(double x, double y) const;
  std::vector<Eigen::Vector2d> at(const std::vector<Eigen::Vector2d>& values) const;
  /// Within the axes.
  const Box& box() const { return box_; }
  /// The same with its axes in a box that lies within the one they have.
  ChartFrame with_box(const Box& box) const;

 private:
  struct Label {
    double at = 0.0;
    std::string text;
    double size = kFontSize;
    double tick = 0.0;  ///< where its value is
  };
  std::vector<Label> x_labels() const;
  std::vector<Label> turned_labels() const;
  std::vector<Label> y_labels() const;
  void draw_x(Canvas& canvas) const;
  void draw_y(Canvas& canvas) const;

  ChartAxis x_;
  ChartAxis y_;
  Box outer_;
  Box box_;
  bool is_turned_ = false;  ///< whether labels of x stand on end
  double label_height_ = kFontSize;
};

}  // namespace fathom
