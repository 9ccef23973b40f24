#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace fathom {

/// Level l has 2^l pixels of the picture to each of its own, averaged.
std::vector<cv::Mat> area_pyramid(const cv::Mat& picture);

/// A pyramid between two of its levels, bilinear in each (Williams, *Pyramidal Parametrics*, 1983).
/// Level 0 has its first pixel's centre at 0, so its left edge, which all levels share, is at −1/2.
class FloorLookup {
 public:
  FloorLookup(const std::vector<cv::Mat>& levels, double world_pixels_per_pixel);

  /// At a pixel of level 0.
  float at(const Eigen::Vector2f& pixel) const;

 private:
  cv::Mat fine_;
  cv::Mat coarse_;
  float scale_ = 1.0F;
  float coarse_share_ = 0.0F;
};

}  // namespace fathom
