#include "floor_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "camera_side.hpp"
#include "caustics.hpp"
#include "fathom/core/input_error.hpp"
#include "floor_lookup.hpp"

namespace fathom {
namespace {

// A ray (x, y) to the floor one metre below, tilted: again that of a metre below.
Eigen::Vector2d tilted(const Eigen::Matrix3d& tilt, const Eigen::Vector2d& ray) {
  const Eigen::Vector3d direction = tilt * Eigen::Vector3d(ray.x(), ray.y(), -1.0);
  return direction.head<2>() / -direction.z();
}

// What becomes of a level ray on its way to the floor of one view.
class Way {
 public:
  Way(const View& view, const HeightField& relief, const Eigen::Vector2d& camera_m, double heading)
      : relief_(relief),
        is_level_(view.tilt.is_level()),
        tilt_(view.tilt.rotation()),
        camera_m_(camera_m.cast<float>()),
        metres_((rotation(heading) * view.altitude_m).cast<float>()),
        per_altitude_(static_cast<float>(1.0 / view.altitude_m)) {}

  bool is_straight() const { return is_level_ && relief_.is_flat(); }

  Eigen::Vector2f tilted(const Eigen::Vector2f& ray) const {
    if (is_level_) return ray;
    return fathom::tilted(tilt_, ray.cast<double>()).cast<float>();
  }

  /// How far down a ray meets the floor, in altitudes.
  float depth(const Eigen::Vector2f& ray) const {
    if (relief_.is_flat()) return 1.0F;
    // Each round takes the error down by the slope along the ray.
    constexpr int kRounds = 6;
    float depth = 1.0F;
    for (int i = 0; i < kRounds; ++i) depth = 1.0F - relief_.at(point(ray * depth)) * per_altitude_;
    return depth;
  }

  /// In the axes of the world's picture, metres.
  Eigen::Vector2f point(const Eigen::Vector2f& ray) const { return camera_m_ + metres_ * ray; }

 private:
  const HeightField& relief_;
  bool is_level_;
  Eigen::Matrix3d tilt_;
  Eigen::Vector2f camera_m_;
  Eigen::Matrix2f metres_;
  float per_altitude_;
};

// Haze along a path: what is lost of the floor's light, backscatter replaces.
class Haze {
 public:
  Haze(const WaterOptions& water, double altitude_m)
      : per_altitude_(static_cast<float>(-water.attenuation_per_m * altitude_m)),
        backscatter_(static_cast<float>(water.backscatter)) {}

  bool is_clear() const { return per_altitude_ == 0.0F; }

  /// At the end of a path of so many altitudes.
  float seen(float grey, float path_altitudes) const {
    return backscatter_ + std::exp(per_altitude_ * path_altitudes) * (grey - backscatter_);
  }

 private:
  float per_altitude_;
  float backscatter_;
};

// What a row of corners of the picture's pixels sees.
struct SeenRow {
  explicit SeenRow(std::size_t corners) : hits(corners), places(corners) {}

  std::vector<Eigen::Vector3f> hits;  ///< from the camera, in altitudes: ahead, to port, down
  FloorLookup::Places places;
};

// Follows a row of rays; returns where the next row begins.
const Eigen::Vector2f* see_row(const Way& way, const FloorLookup& floor,
                               const Eigen::Vector2f* level_ray, SeenRow& row) {
  for (std::size_t i = 0; i < row.hits.size(); ++i) {
    Eigen::Vector2f ray = *level_ray++;
    float depth = 1.0F;
    if (!way.is_straight()) {
      ray = way.tilted(ray);
      depth = way.depth(ray);
    }
    row.hits[i] << depth * ray, depth;
    const Eigen::Vector2f place = floor.place(depth * ray);
    row.places.x[i] = place.x();
    row.places.y[i] = place.y();
  }
  return level_ray;
}

}  // namespace

ViewRays::ViewRays(const Camera& camera)
    : mount_m_(camera.model().mount_x_m, camera.model().mount_y_m) {
  const int width = camera.model().width;
  const int height = camera.model().height;
  corners_.reserve(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1));
  for (int v = 0; v <= height; ++v) {
    for (int u = 0; u <= width; ++u) {
      const Eigen::Vector2d ray = camera.floor_point({u - 0.5, v - 0.5}, 1.0) - mount_m_;
      if (!ray.allFinite()) {
        throw InputError("camera distortion cannot be undone at pixel (" + std::to_string(u) +
                         ", " + std::to_string(v) + ")");
      }
      corners_.push_back(ray.cast<float>());
      if (u == 0 || v == 0 || u == width || v == height) border_.push_back(ray);
    }
  }
}

Eigen::AlignedBox2d ViewRays::seen(const Pose& pose, double altitude_m, const Tilt& tilt) const {
  const Eigen::Matrix2d R = rotation(pose.theta);
  const Eigen::Matrix3d tilt_rotation = tilt.rotation();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& level : border_) {
    if (tilt_rotation.row(2) * Eigen::Vector3d(level.x(), level.y(), -1.0) >= 0.0) {
      throw InputError("a camera tilted by " + std::to_string(tilt.roll_rad) + " and " +
                       std::to_string(tilt.pitch_rad) + " rad sees the horizon; tilt it less");
    }
    const Eigen::Vector2d ray = tilt.is_level() ? level : tilted(tilt_rotation, level);
    box.extend(R * (mount_m_ + altitude_m * ray));
  }
  return box.translate(pose.position());
}

double finest_pixel_m(const CameraModel& camera, double altitude_m) {
  return altitude_m / std::max(camera.fx, camera.fy);
}

FloorRenderer::FloorRenderer(const Camera& camera, ViewRays rays, World world)
    : camera_(camera),
      rays_(std::move(rays)),
      world_(std::move(world)),
      levels_(area_pyramid(world_.picture)) {}

cv::Mat FloorRenderer::render(const View& view, const PictureEffects& effects) const {
  cv::Mat_<float> light = trace(view, effects);
  if (effects.any()) light = seen_by_camera(light, camera_, view, effects);
  cv::Mat picture;
  light.convertTo(picture, CV_8U);
  return picture;
}

// What light of the floor, and of the water before it, comes to each pixel; grey levels.
cv::Mat_<float> FloorRenderer::trace(const View& view, const PictureEffects& effects) const {
  const CameraModel& camera = camera_.model();
  const Pose body = compose(world_.mission, view.pose);
  // Pixels of the world are affine in the ray: pixel = world.pixel(camera) + A ray.
  const Eigen::Vector2d camera_m =
      transform(body, Eigen::Vector2d(camera.mount_x_m, camera.mount_y_m));
  const Eigen::Matrix2d R = rotation(body.theta) * (view.altitude_m / world_.metres_per_pixel);
  Eigen::Matrix2d A;
  A.row(0) = -R.row(1);
  A.row(1) = -R.row(0);
  const FloorLookup floor(levels_, world_.pixel(camera_m), A,
                          finest_pixel_m(camera, view.altitude_m) / world_.metres_per_pixel);
  const Way way(view, world_.relief, camera_m, body.theta);
  const Haze haze(effects.water, view.altitude_m);
  const Caustics caustics(effects.water.caustics, view.seed);
  const bool is_plain = caustics.are_off() && haze.is_clear();
  const auto width = static_cast<std::size_t>(camera.width);
  SeenRow upper(width + 1);
  SeenRow lower(width + 1);
  const Eigen::Vector2f* rays = rays_.corners().data();
  rays = see_row(way, floor, rays, lower);
  cv::Mat_<float> light(camera.height, camera.width);
  for (int v = 0; v < camera.height; ++v) {
    std::swap(upper, lower);
    rays = see_row(way, floor, rays, lower);
    float* out = light[v];
    floor.means(upper.places, lower.places, out);
    if (is_plain) continue;
    for (std::size_t u = 0; u < width; ++u) {
      const Eigen::Vector3f middle =
          0.25F * (upper.hits[u] + upper.hits[u + 1] + lower.hits[u] + lower.hits[u + 1]);
      if (!caustics.are_off()) out[u] *= caustics.gain(way.point(middle.head<2>()));
      if (!haze.is_clear()) out[u] = haze.seen(out[u], middle.norm());
    }
  }
  return light;
}

}  // namespace fathom
