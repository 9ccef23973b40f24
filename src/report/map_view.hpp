#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "canvas.hpp"

namespace fathom {

/// A part of the world seen from above with x up and y to the left, the same scale along both.
class MapView {
 public:
  /// Fits the box of the points, with a margin, into `frame`. Without points, 1 m round the origin.
  MapView(const std::vector<Eigen::Vector2d>& points, const PixelBox& frame);

  Eigen::Vector2d pixel(const Eigen::Vector2d& world) const;
  double pixels_per_metre() const { return pixels_per_metre_; }
  const PixelBox& frame() const { return frame_; }

  /// Of the longest label of the x axis.
  double label_width_px() const;

  /// Grid lines with their labels in metres, and the frame.
  void draw_grid(Canvas& canvas) const;

 private:
  struct Span {
    double low = 0.0;
    double high = 0.0;
  };
  Span x_span() const;
  Span y_span() const;
  double grid_step() const;

  PixelBox frame_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();
  double pixels_per_metre_ = 1.0;
};

/// The least of 1, 2 and 5 times a power of ten that is no less than `least` > 0.
double round_step(double least);

/// A coordinate with as many decimals as its grid's step has; from steps of 1e6 with an exponent.
std::string coordinate_text(double value, double step);

}  // namespace fathom
