#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "fathom/core/options.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// The floor that a simulation flies over, and where the mission lies on it.
struct WorldOptions {
  std::string picture;  ///< file; empty: a procedural sea floor
  double metres_per_pixel = 0.004;
  double heading_rad = 0.0;
  std::optional<double> origin_x_m;
  std::optional<double> origin_y_m;

  void describe(OptionTable& table);
};

/// A flat floor as one picture, drawn with x up and y to the left about its middle.
struct World {
  cv::Mat picture;  ///< 8-bit, one channel
  double metres_per_pixel = 0.0;
  /// Pose of the mission's frame in the axes of the picture (metres, origin in its middle).
  Pose mission;

  /// The pixel (u right, v down; centres at whole numbers) of a point in the picture's axes.
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const;

  /// What the pixel centres span, in the picture's axes; metres.
  Eigen::AlignedBox2d extent() const;
};

/// Reads or draws the world of a mission that sees `seen`: a box in the axes of the picture whose
/// origin is frame 0, metres. A procedural floor is made as large as the box and a margin; on a
/// given picture the box is centred unless the options say where frame 0 lies. Whether it fits is
/// for the caller to check. Throws InputError naming `key_prefix` + the key.
World make_world(const WorldOptions& options, const Eigen::AlignedBox2d& seen, std::uint64_t seed,
                 const std::string& key_prefix);

}  // namespace fathom
