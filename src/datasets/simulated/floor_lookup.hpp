#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace fathom {

/// Level l has 2^l pixels of the picture to each of its own, averaged.
std::vector<cv::Mat> area_pyramid(const cv::Mat& picture);

/// What one view sees of a floor, by level of a pyramid that has at least two pixels to one of the
/// view's, if level 0 has. Level 0 has its first pixel's centre at 0, so its left edge, which all
/// levels share, is at −1/2.
class FloorLookup {
 public:
  /// A row of corners of the view's pixels, as places in the level.
  struct Places {
    explicit Places(std::size_t corners) : x(corners), y(corners) {}

    std::vector<float> x;
    std::vector<float> y;
  };

  /// A point p of the view is the pixel `base` + `A` p of level 0, and a pixel of the view about
  /// `floor_pixels_per_pixel` of them wide.
  FloorLookup(const std::vector<cv::Mat>& levels, const Eigen::Vector2d& base,
              const Eigen::Matrix2d& A, double floor_pixels_per_pixel);

  /// The place in the level of a point of the view, from an origin near the view's middle, where
  /// floats are fine enough.
  Eigen::Vector2f place(const Eigen::Vector2f& point) const { return base_ + A_ * point; }

  /// Mean grey over each pixel of a row of the view, between its upper and its lower corners, one
  /// more of each than there are pixels. Beyond the floor its border repeats.
  void means(const Places& upper, const Places& lower, float* out) const;

 private:
  static constexpr std::size_t kBlock = 32;
  using Values = std::array<float, kBlock>;
  struct Block;

  bool are_inside(const Places& places, std::size_t first, std::size_t count) const;
  template <bool kNearBorder>
  void mean_of_samples(const Block& block, Values& means) const;
  template <bool kNearBorder>
  void add_samples(Values x, Values y, Values& sums) const;

  cv::Mat level_;
  Eigen::Vector2f base_;
  Eigen::Matrix2f A_;
  std::ptrdiff_t row_bytes_ = 0;
  std::ptrdiff_t offset_ = 0;  ///< of place (0, 0) in the level's data, bytes; may lie outside
  Eigen::Vector2f first_;      ///< places of the first and the last pixel
  Eigen::Vector2f last_;
};

}  // namespace fathom
