#include "seen_floor.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

std::string metres(double value) {
  char buffer[48];
  std::snprintf(buffer, sizeof buffer, "%.2f m", value);
  return buffer;
}

// Which side of the world a view leaves and by how much, or nothing.
std::string beyond(const Eigen::AlignedBox2d& world, const Eigen::AlignedBox2d& view) {
  const struct {
    const char* side;
    double by_m;
  } sides[] = {{"top", view.max().x() - world.max().x()},
               {"bottom", world.min().x() - view.min().x()},
               {"left", view.max().y() - world.max().y()},
               {"right", world.min().y() - view.min().y()}};
  const auto& worst =
      *std::max_element(std::begin(sides), std::end(sides),
                        [](const auto& a, const auto& b) { return a.by_m < b.by_m; });
  return worst.by_m > 0.0 ? metres(worst.by_m) + " beyond the picture's " + worst.side : "";
}

// A floor as low as it may be is seen farthest.
Eigen::AlignedBox2d view_box(const ViewRays& rays, const Pose& pose, const View& view,
                             double relief_m, const std::string& prefix) {
  try {
    return rays.seen(pose, view.altitude_m + relief_m, view.tilt);
  } catch (const InputError& error) {
    throw InputError(prefix + "attitude: " + error.what());
  }
}

[[noreturn]] void refuse_view(const std::string& what, const FrameInfo& info, std::size_t frame,
                              const Eigen::Vector2d& mission_m, const Eigen::Vector2d& world_m,
                              const std::string& prefix) {
  throw InputError(
      fmt::format("{}world.picture: frame {} at {} s sees {}; the mission sees {} up by {} across, "
                  "the picture has {} by {}: shorten the mission, fly lower, or change "
                  "world.metres_per_pixel, heading_rad, origin_x_m or origin_y_m",
                  prefix, frame, seconds_text(info.time_ns), what, metres(mission_m.x()),
                  metres(mission_m.y()), metres(world_m.x()), metres(world_m.y())));
}

}  // namespace

SeenFloor seen_floor(const ViewRays& rays, const std::vector<View>& views,
                     const WorldOptions& options, const std::string& prefix) {
  SeenFloor seen;
  for (const View& view : views) {
    const Pose pose = compose({0, 0, options.heading_rad}, view.pose);
    seen.boxes.push_back(view_box(rays, pose, view, options.relief_m, prefix));
    seen.all.extend(seen.boxes.back());
  }
  return seen;
}

void require_inside(const WorldPlan& world, const SeenFloor& seen,
                    const std::vector<FrameInfo>& infos, const std::string& prefix) {
  const Eigen::AlignedBox2d extent = world.extent().translated(-world.mission.position());
  for (std::size_t i = 0; i < seen.boxes.size(); ++i) {
    const std::string what = beyond(extent, seen.boxes[i]);
    if (!what.empty()) refuse_view(what, infos[i], i, seen.all.sizes(), extent.sizes(), prefix);
  }
}

}  // namespace fathom
