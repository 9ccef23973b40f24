#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "fathom/core/hash.hpp"
#include "fathom/core/options.hpp"
#include "fathom/geometry/pose.hpp"
#include "height_field.hpp"
#include "sea_floor.hpp"

namespace fathom {

/// The coarsest pixel of a floor for pictures whose finest pixel is that: a √5th, so that it is
/// more than twice as fine, and no round altitude or speed lets the two grids fall together.
double floor_pixel_m(double finest_pixel_m);

/// The floor that a simulation flies over, and where the mission lies on it.
struct WorldOptions {
  std::string picture;                 ///< file; empty: a procedural sea floor
  FloorKind floor = FloorKind::mixed;  ///< of a procedural sea floor
  double relief_m = 0.0;               ///< the floor lies so far above and below its mean at most
  double metres_per_pixel = 0.004;
  double heading_rad = 0.0;
  std::optional<double> origin_x_m;
  std::optional<double> origin_y_m;

  void describe(OptionTable& table);
};

/// A floor as one picture, drawn with x up and y to the left about its middle: flat, or draped over
/// a relief.
struct World {
  cv::Mat picture;  ///< 8-bit, one channel
  double metres_per_pixel = 0.0;
  /// Pose of the mission's frame in the axes of the picture (metres, origin in its middle).
  Pose mission;
  HeightField relief = {};  ///< in the axes of the picture; flat unless asked for

  /// The pixel (u right, v down; centres at whole numbers) of a point in the picture's axes.
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const;
};

/// The world with its picture as fine as pictures whose finest pixel is that need it: doubled until
/// a pixel is at most half of that one, but twice at most, after which nothing is left that a finer
/// grid would show. Cubic convolution (Keys 1981), which keeps slopes and curvatures.
World refined(World world, double finest_pixel_m);

/// A world as it will be, without its pixels where they can wait.
struct WorldPlan {
  cv::Size size;
  double metres_per_pixel = 0.0;
  Pose mission;                  ///< as of World
  cv::Mat picture;               ///< the given one; empty: a floor is drawn
  std::uint64_t floor_seed = 0;  ///< of a floor that is drawn
  FloorKind floor = FloorKind::mixed;
  double relief_m = 0.0;
  std::uint64_t relief_seed = 0;
  std::uint64_t file_id = 0;    ///< hash of the given picture's file; 0 without one
  double finest_pixel_m = 0.0;  ///< of the pictures to be taken; for a given picture

  /// What the pixel centres span, in the picture's axes; metres.
  Eigen::AlignedBox2d extent() const;

  /// Draws the floor, which takes seconds for a large one.
  World make() const;

  /// All that determines the world.
  void add_to(Hash& hash) const;
};

/// What a mission sees of the floor.
struct MissionView {
  Eigen::AlignedBox2d seen;     ///< in the axes of the world's picture, origin at frame 0; metres
  double finest_pixel_m = 0.0;  ///< shortest side of any picture's pixels on the floor
};

/// Plans the world of a mission. A procedural floor is made as large as what is seen and a margin,
/// and as fine as its pictures need; on a given picture the mission is centred unless the options
/// say where frame 0 lies. Whether it fits is for the caller to check. A given picture is read for
/// its size. Throws InputError naming `key_prefix` + the key.
WorldPlan plan_world(const WorldOptions& options, const MissionView& mission, std::uint64_t seed,
                     const std::string& key_prefix);

}  // namespace fathom
