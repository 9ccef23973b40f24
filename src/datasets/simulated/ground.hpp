#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/core/random.hpp"

namespace fathom {

using Row = std::vector<float>;

inline float smooth_step(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// A floor without its stones: heights lit from the upper left, on ground of uneven grey.
class Ground {
 public:
  explicit Ground(double metres_per_pixel) : metres_per_pixel_(metres_per_pixel) {}
  virtual ~Ground() = default;

  /// Some rows of an 8-bit grey picture. May be called from several threads at once.
  void draw(cv::Mat& picture, const cv::Range& rows) const;

 private:
  /// Heights along a row of the picture, metres.
  virtual void heights(int row, Row& out_m) const = 0;

  /// The grey of level ground along a row, and how strongly a slope shows there.
  virtual void surface(int row, Row& grey, Row& slope_gain) const = 0;

  double metres_per_pixel_;
};

// The grounds of the kinds of sea floor, for pictures of a size in pixels.
std::unique_ptr<Ground> mixed_ground(cv::Size size, double metres_per_pixel, RandomStream& stream);
std::unique_ptr<Ground> rippled_ground(cv::Size size, double metres_per_pixel,
                                       RandomStream& stream);
std::unique_ptr<Ground> muddy_ground(cv::Size size, double metres_per_pixel, RandomStream& stream);
std::unique_ptr<Ground> sandy_ground(cv::Size size, double metres_per_pixel, RandomStream& stream);
std::unique_ptr<Ground> patchy_ground(cv::Size size, double metres_per_pixel, RandomStream& stream);

}  // namespace fathom
