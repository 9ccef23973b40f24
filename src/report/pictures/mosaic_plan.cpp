#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <limits>

#include <nlohmann/json.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/report/mosaic.hpp"
#include "fathom/vision/features.hpp"
#include "floor_map.hpp"

namespace fathom {
namespace {

/// Of the shorter side of a footprint: how far a corner moves from one picture laid to the next.
constexpr double kStep = 1.0 / 3.0;

using Corners = std::array<Eigen::Vector2d, 4>;

std::string short_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

struct LaidFootprint {
  Corners corners;  ///< world
  double shorter_side_m = 0.0;
  double metres_per_pixel = 0.0;
};

double shorter_side_of(const Corners& c) {
  return std::min((c[1] - c[0]).norm(), (c[2] - c[1]).norm());
}

// Twice the area of the two triangles of a quadrangle is the cross product of its diagonals.
double area_of(const Corners& c) {
  const Eigen::Vector2d a = c[2] - c[0];
  const Eigen::Vector2d b = c[3] - c[1];
  return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

LaidFootprint footprint_of(const Camera& camera, const PlacedPicture& picture) {
  const Pose& pose = picture.pose;
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.theta)) {
    throw InputError("the pose of frame " + std::to_string(picture.frame) + " is not finite");
  }
  LaidFootprint footprint{camera.footprint(picture.stance), 0.0, 0.0};
  const CameraModel& model = camera.model();
  const double pixels = static_cast<double>(model.width) * model.height;
  // A lens that bends much leaves most of the area between the corners to a few pixels, or to none.
  footprint.metres_per_pixel = model.has_straight_sides()
                                   ? std::sqrt(area_of(footprint.corners) / pixels)
                                   : metres_per_pixel(model, picture.stance.altitude_m);
  footprint.shorter_side_m = shorter_side_of(footprint.corners);
  for (Eigen::Vector2d& corner : footprint.corners) corner = transform(pose, corner);
  return footprint;
}

double largest_step(const Corners& from, const Corners& to) {
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    largest = std::max(largest, (to[i] - from[i]).norm());
  }
  return largest;
}

// Whether two pictures overlap by so little that one between them may show what neither does.
bool is_leap(const Camera& camera, const PlacedPicture& from, const PlacedPicture& to) {
  constexpr double kLeastOverlap = 0.2;
  const Pose motion = compose(inverse(from.pose), to.pose);
  // Poses at the end of all numbers may leave none.
  return !motion.position().allFinite() ||
         footprint_overlap(camera, from.stance, to.stance, motion) < kLeastOverlap;
}

// The next picture from i on that is no filler, or the last one.
std::size_t next_anchor(std::span<const PlacedPicture> pictures, std::size_t i) {
  while (i + 1 < pictures.size() && pictures[i].is_filler) ++i;
  return i;
}

// Indices of the pictures that are laid, rising.
std::vector<std::size_t> laid_of(const Camera& camera, std::span<const PlacedPicture> pictures) {
  for (const PlacedPicture& picture : pictures) footprint_of(camera, picture);  // all are sound
  std::vector<std::size_t> laid{0};
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    const PlacedPicture& last = pictures[laid.back()];
    const PlacedPicture& next = pictures[i];
    if (next.is_filler && !is_leap(camera, last, pictures[next_anchor(pictures, i)])) continue;
    const LaidFootprint from = footprint_of(camera, last);
    const LaidFootprint to = footprint_of(camera, next);
    const bool is_near = largest_step(from.corners, to.corners) <
                         kStep * std::min(from.shorter_side_m, to.shorter_side_m);
    // What is no filler is worth more than the filler before it.
    const bool is_better = last.is_filler && !next.is_filler;
    if (is_near && !is_better && i + 1 < pictures.size()) continue;
    if (laid.back() + 1 < i && is_leap(camera, last, next)) laid.push_back(i - 1);
    laid.push_back(i);
  }
  return laid;
}

template <class Member>
double median_of(const std::vector<LaidFootprint>& footprints, Member member) {
  std::vector<double> values;
  values.reserve(footprints.size());
  for (const LaidFootprint& footprint : footprints) values.push_back(footprint.*member);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct FloorBox {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  double largest_picture_m2 = 0.0;  ///< of the box of one of its pictures

  void add(const FloorBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    largest_picture_m2 = std::max(largest_picture_m2, (other.high - other.low).prod());
  }
};

FloorBox box_of(const Camera& camera, const std::vector<PlacedPicture>& pictures) {
  FloorBox box;
  for (const PlacedPicture& picture : pictures) {
    FloorBox one;
    for (const Eigen::Vector2d& point : seen_outline(camera, picture.stance)) {
      const Eigen::Vector2d world = transform(picture.pose, point);
      one.add({world, world});
    }
    box.add(one);
  }
  return box;
}

// Of the box of a picture, for which a mask is made. A box on the slant is twice the picture.
double most_picture_pixels(const CameraModel& model) {
  return std::max(64e6, 4.0 * model.width * model.height);
}

// Width and height on the grid of whole pixels, not yet as integers: they may be beyond those.
Eigen::Vector2d size_px(const FloorBox& box, double metres_per_pixel) {
  const Eigen::Vector2d high = (box.high / metres_per_pixel).array().ceil();
  const Eigen::Vector2d low = (box.low / metres_per_pixel).array().floor();
  const Eigen::Vector2d extent = (high - low).cwiseMax(1.0);
  return {extent.y(), extent.x()};
}

double fitting_resolution(const FloorBox& box, double metres_per_pixel,
                          const MosaicOptions& options, const CameraModel& model) {
  metres_per_pixel =
      std::max(metres_per_pixel, std::sqrt(box.largest_picture_m2 / most_picture_pixels(model)));
  while (true) {
    const Eigen::Vector2d size = size_px(box, metres_per_pixel);
    const double excess =
        std::max(std::sqrt(size.prod() / options.most_pixels),
                 size.maxCoeff() / std::min(options.longest_px, options.most_pixels));
    if (excess <= 1.0) return metres_per_pixel;
    // A little more than it takes, as sizes are rounded up.
    metres_per_pixel *= 1.001 * excess;
  }
}

void require_options(const MosaicOptions& options) {
  if (!(options.most_pixels >= 1.0)) throw InputError("a mosaic has one pixel at least");
  if (!options.metres_per_pixel) return;
  const double m = *options.metres_per_pixel;
  if (std::isfinite(m) && m > 0.0) return;
  throw InputError("the resolution must be a number of metres per pixel above zero, got " +
                   short_text(m));
}

// A mosaic of which each picture is a few pixels is no map, but a trajectory gone wild.
void require_no_specks(const FloorBox& box, const MosaicPlan& plan, double shorter_side_m) {
  constexpr double kFewestPx = 4.0;
  if (plan.wanted_metres_per_pixel * kFewestPx > shorter_side_m) {
    throw InputError(
        fmt::format("a resolution of {} m per pixel is too coarse for pictures of {} m",
                    short_text(plan.wanted_metres_per_pixel), short_text(shorter_side_m)));
  }
  if (plan.metres_per_pixel * kFewestPx <= shorter_side_m) return;
  const Eigen::Vector2d extent = box.high - box.low;
  throw InputError(
      fmt::format("the trajectory covers {} m x {} m, on which pictures of {} m would be specks",
                  short_text(extent.x()), short_text(extent.y()), short_text(shorter_side_m)));
}

}  // namespace

MosaicPlan plan_mosaic(const Camera& camera, std::span<const PlacedPicture> pictures,
                       const MosaicOptions& options) {
  require_options(options);
  if (pictures.empty()) throw InputError("a mosaic needs at least one picture with a pose");
  MosaicPlan plan;
  plan.blend = options.blend;
  std::vector<LaidFootprint> laid;
  for (const std::size_t i : laid_of(camera, pictures)) {
    plan.pictures.push_back(pictures[i]);
    laid.push_back(footprint_of(camera, pictures[i]));
  }
  const FloorBox box = box_of(camera, plan.pictures);
  plan.wanted_metres_per_pixel =
      options.metres_per_pixel.value_or(median_of(laid, &LaidFootprint::metres_per_pixel));
  plan.metres_per_pixel =
      fitting_resolution(box, plan.wanted_metres_per_pixel, options, camera.model());
  require_no_specks(box, plan, median_of(laid, &LaidFootprint::shorter_side_m));
  const Eigen::Vector2d size = size_px(box, plan.metres_per_pixel);
  plan.size = cv::Size(static_cast<int>(size.x()), static_cast<int>(size.y()));
  plan.top_left_m = (box.high / plan.metres_per_pixel).array().ceil() * plan.metres_per_pixel;
  return plan;
}

std::string mosaic_json(const MosaicPlan& plan, const MosaicFiles& files) {
  nlohmann::ordered_json json;
  json["metres_per_pixel"] = plan.metres_per_pixel;
  json["x_of_top_left_m"] = plan.top_left_m.x();
  json["y_of_top_left_m"] = plan.top_left_m.y();
  json["width_px"] = plan.size.width;
  json["height_px"] = plan.size.height;
  json["pictures"] = plan.pictures.size();
  json["blend"] = plan.blend == MosaicBlend::seams ? "seams" : "feather";
  if (files.world_file_epsg) json["world_file_epsg"] = *files.world_file_epsg;
  if (files.tile_px) {
    json["tile_px"] = *files.tile_px;
    json["tiles"] = files.tiles;
  }
  return json.dump(2) + "\n";
}

}  // namespace fathom
