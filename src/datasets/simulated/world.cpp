#include "fathom/datasets/world.hpp"

#include <cmath>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "fathom/datasets/picture_file.hpp"

namespace fathom {
namespace {

// Beyond it a floor and its pyramid no longer fit an ordinary memory.
constexpr double kMaxPixels = 400e6;

// Room around what a mission sees, so that rounding cannot leave a border pixel outside.
constexpr double kMarginM = 0.25;

cv::Size floor_size(const Eigen::Vector2d& size_m, double metres_per_pixel,
                    const std::string& prefix) {
  const Eigen::Vector2d padded_m = size_m.array() + 2.0 * kMarginM;
  const double rows = std::ceil(padded_m.x() / metres_per_pixel) + 1.0;
  const double columns = std::ceil(padded_m.y() / metres_per_pixel) + 1.0;
  if (!(rows * columns <= kMaxPixels)) {
    const double enough = std::sqrt(padded_m.prod() / kMaxPixels) * 1.01;
    throw InputError(prefix + "metres_per_pixel: the floor that the mission sees would have more " +
                     "than 400 million pixels; raise it to " + std::to_string(enough) +
                     " or shorten the mission");
  }
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

}  // namespace

void WorldOptions::describe(OptionTable& table) {
  table.text("picture", picture, "picture of the floor; empty: a procedural sea floor");
  table.enumeration("floor", floor, floor_kinds(), "procedural sea floor: what lies on it");
  table.real("relief_m", relief_m, Range::at_least(0), "m",
             "the floor rises and falls by at most this about its mean; 0: flat");
  table.real("metres_per_pixel", metres_per_pixel, Range::positive(), "m",
             "size of a pixel of the floor's picture");
  table.real("heading_rad", heading_rad, Range::any(), "rad",
             "heading of frame 0 in the picture, counter-clockwise; 0: up");
  table.real_or_off("origin_x_m", origin_x_m, Range::any(), "m",
                    "frame 0 above the picture's middle; off: the mission is centred");
  table.real_or_off("origin_y_m", origin_y_m, Range::any(), "m",
                    "frame 0 left of the picture's middle; off: the mission is centred");
}

Eigen::Vector2d World::pixel(const Eigen::Vector2d& point) const {
  return {(picture.cols - 1) / 2.0 - point.y() / metres_per_pixel,
          (picture.rows - 1) / 2.0 - point.x() / metres_per_pixel};
}

Eigen::AlignedBox2d WorldPlan::extent() const {
  const Eigen::Vector2d half{(size.height - 1) / 2.0 * metres_per_pixel,
                             (size.width - 1) / 2.0 * metres_per_pixel};
  return {-half, half};
}

World WorldPlan::make() const {
  const cv::Mat pixels =
      picture.empty() ? draw_sea_floor(size, metres_per_pixel, floor_seed, floor) : picture;
  World world{pixels, metres_per_pixel, mission};
  if (relief_m > 0.0) world.relief = draw_relief(extent(), relief_m, relief_seed);
  return world;
}

void WorldPlan::add_to(Hash& hash) const {
  hash.add(size.width).add(size.height).add(metres_per_pixel);
  hash.add(mission.x).add(mission.y).add(mission.theta);
  hash.add(picture.empty()).add(floor_seed).add(file_id);
  // Words that a plain world does not have, so that its pictures keep their numbers.
  if (floor != FloorKind::mixed) hash.add("floor").add(static_cast<int>(floor));
  if (relief_m > 0.0) hash.add("relief").add(relief_m).add(relief_seed);
}

WorldPlan plan_world(const WorldOptions& options, const Eigen::AlignedBox2d& seen,
                     std::uint64_t seed, const std::string& prefix) {
  WorldPlan plan;
  plan.metres_per_pixel = options.metres_per_pixel;
  plan.mission = {options.origin_x_m.value_or(-seen.center().x()),
                  options.origin_y_m.value_or(-seen.center().y()), wrap_angle(options.heading_rad)};
  plan.relief_m = options.relief_m;
  plan.relief_seed = stream_seed(seed, "sea_floor_relief", 0);
  if (!options.picture.empty()) {
    if (options.floor != FloorKind::mixed) {
      throw InputError(prefix + "floor: is for a procedural floor; a picture is given");
    }
    const std::string bytes = read_file(options.picture);
    plan.picture = decode_grey_picture(bytes, options.picture);
    plan.size = plan.picture.size();
    plan.file_id = Hash().add(bytes).value();
    return plan;
  }
  if (options.origin_x_m || options.origin_y_m) {
    throw InputError(prefix + (options.origin_x_m ? "origin_x_m" : "origin_y_m") +
                     ": is for a given picture; a procedural floor is made around the mission");
  }
  plan.size = floor_size(seen.sizes(), options.metres_per_pixel, prefix);
  plan.floor = options.floor;
  plan.floor_seed = stream_seed(seed, "sea_floor", 0);
  return plan;
}

}  // namespace fathom
