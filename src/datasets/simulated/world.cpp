#include "world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "fathom/datasets/picture_file.hpp"

namespace fathom {
namespace {

// Beyond it a floor and its pyramid no longer fit an ordinary memory.
constexpr double kMaxPixels = 1e9;

// More doublings of a given picture show nothing more.
constexpr int kMostDoublings = 2;

// Room around what a mission sees, so that rounding cannot leave a border pixel outside.
constexpr double kMarginM = 0.25;

[[noreturn]] void refuse_floor(const WorldOptions& options, const Eigen::Vector2d& padded_m,
                               double pixel_m, const std::string& prefix) {
  const double enough = std::sqrt(padded_m.prod() / kMaxPixels) * 1.01;
  std::string message = prefix + "metres_per_pixel: the floor that the mission sees would have " +
                        "more than 1000 million pixels";
  if (pixel_m < options.metres_per_pixel) {
    message += " of the " + std::to_string(pixel_m) + " m that its pictures need";
    message += "; fly higher, shorten the mission or lower the camera's focal lengths";
  } else {
    message += "; raise it to " + std::to_string(enough) + " or shorten the mission";
  }
  throw InputError(message);
}

cv::Size floor_size(const WorldOptions& options, const Eigen::Vector2d& size_m, double pixel_m,
                    const std::string& prefix) {
  const Eigen::Vector2d padded_m = size_m.array() + 2.0 * kMarginM;
  const double rows = std::ceil(padded_m.x() / pixel_m) + 1.0;
  const double columns = std::ceil(padded_m.y() / pixel_m) + 1.0;
  if (!(rows * columns <= kMaxPixels)) refuse_floor(options, padded_m, pixel_m, prefix);
  return {static_cast<int>(columns), static_cast<int>(rows)};
}

int doublings(double metres_per_pixel, double finest_pixel_m) {
  int count = 0;
  while (count < kMostDoublings && metres_per_pixel > 0.5 * finest_pixel_m) {
    metres_per_pixel *= 0.5;
    ++count;
  }
  return count;
}

void require_room(const WorldPlan& plan, const std::string& prefix) {
  const int times = doublings(plan.metres_per_pixel, plan.finest_pixel_m);
  if (std::ldexp(static_cast<double>(plan.picture.total()), 2 * times) <= kMaxPixels) return;
  throw InputError(prefix + "picture: pictures from so near need it " + std::to_string(1 << times) +
                   " times as fine, which would be more than 1000 " +
                   "million pixels; fly higher or take a part of it");
}

// Pixel i becomes 2 i, a quarter of a pixel before its middle, and 2 i + 1, as much behind it.
cv::Mat doubled(const cv::Mat& picture) {
  // Keys' weights (a = −1/2) of the pixels −2 … 2 at −1/4; mirrored at 1/4.
  const cv::Matx<float, 1, 5> before(-3 / 128.0F, 29 / 128.0F, 111 / 128.0F, -9 / 128.0F, 0.0F);
  const cv::Matx<float, 1, 5> behind(0.0F, -9 / 128.0F, 111 / 128.0F, 29 / 128.0F, -3 / 128.0F);
  cv::Mat twice(2 * picture.rows, 2 * picture.cols, CV_8UC1);
  cv::Mat part;
  for (const int down : {0, 1}) {
    for (const int across : {0, 1}) {
      cv::sepFilter2D(picture, part, CV_8U, across == 0 ? before : behind,
                      down == 0 ? before : behind, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
      for (int row = 0; row < picture.rows; ++row) {
        const uchar* from = part.ptr(row);
        uchar* to = twice.ptr(2 * row + down) + across;
        for (std::ptrdiff_t column = 0; column < picture.cols; ++column) {
          to[2 * column] = from[column];
        }
      }
    }
  }
  return twice;
}

}  // namespace

double floor_pixel_m(double finest_pixel_m) {
  return finest_pixel_m / std::sqrt(5.0);
}

void WorldOptions::describe(OptionTable& table) {
  table.text("picture", picture, "picture of the floor; empty: a procedural sea floor");
  table.enumeration("floor", floor, floor_kinds(), "procedural sea floor: what lies on it");
  table.real("relief_m", relief_m, Range::at_least(0), "m",
             "the floor rises and falls by at most this about its mean; 0: flat");
  table.real("metres_per_pixel", metres_per_pixel, Range::positive(), "m",
             "size of a pixel of the floor's picture; a procedural floor is drawn as fine as its "
             "pictures need, if that is finer");
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

World refined(World world, double finest_pixel_m) {
  for (int i = doublings(world.metres_per_pixel, finest_pixel_m); i > 0; --i) {
    world.picture = doubled(world.picture);
    world.metres_per_pixel *= 0.5;
  }
  return world;
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
  if (!picture.empty()) world = refined(std::move(world), finest_pixel_m);
  if (relief_m > 0.0) world.relief = draw_relief(extent(), relief_m, relief_seed);
  return world;
}

void WorldPlan::add_to(Hash& hash) const {
  hash.add(size.width).add(size.height).add(metres_per_pixel);
  hash.add(mission.x).add(mission.y).add(mission.theta);
  hash.add(picture.empty()).add(floor_seed).add(file_id);
  if (!picture.empty()) hash.add(doublings(metres_per_pixel, finest_pixel_m));
  // Words that a plain world does not have, so that its pictures keep their numbers.
  if (floor != FloorKind::mixed) hash.add("floor").add(static_cast<int>(floor));
  if (relief_m > 0.0) hash.add("relief").add(relief_m).add(relief_seed);
}

WorldPlan plan_world(const WorldOptions& options, const MissionView& mission, std::uint64_t seed,
                     const std::string& prefix) {
  const Eigen::AlignedBox2d& seen = mission.seen;
  WorldPlan plan;
  plan.metres_per_pixel = options.metres_per_pixel;
  plan.finest_pixel_m = mission.finest_pixel_m;
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
    require_room(plan, prefix);
    plan.file_id = Hash().add(bytes).value();
    return plan;
  }
  if (options.origin_x_m || options.origin_y_m) {
    throw InputError(prefix + (options.origin_x_m ? "origin_x_m" : "origin_y_m") +
                     ": is for a given picture; a procedural floor is made around the mission");
  }
  plan.metres_per_pixel = std::min(options.metres_per_pixel, floor_pixel_m(mission.finest_pixel_m));
  plan.size = floor_size(options, seen.sizes(), plan.metres_per_pixel, prefix);
  plan.floor = options.floor;
  plan.floor_seed = stream_seed(seed, "sea_floor", 0);
  return plan;
}

}  // namespace fathom
