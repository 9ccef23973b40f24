#pragma once

#include <cstdint>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace fathom {

/// Heights of a floor above its mean plane, on a grid of metres, bilinear between its points.
struct HeightField {
  cv::Mat_<float> heights_m;  ///< empty: flat; drawn with x up and y to the left
  double metres_per_cell = 0.0;
  Eigen::Vector2d first_m = Eigen::Vector2d::Zero();  ///< the point of heights_m(0, 0)

  bool is_flat() const { return heights_m.empty(); }

  /// At a point (x, y); beyond the grid the height of its border.
  float at(const Eigen::Vector2f& point) const;
};

/// A smooth random relief over a box in metres, of wavelengths of some 0.3 to 1.5 m and zero mean,
/// scaled so that the point farthest from the mean plane is `highest_m` > 0 away. The same
/// arguments give the same relief.
HeightField draw_relief(const Eigen::AlignedBox2d& box, double highest_m, std::uint64_t seed);

}  // namespace fathom
