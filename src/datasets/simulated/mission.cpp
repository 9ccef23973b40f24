#include "fathom/datasets/mission.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <utility>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

constexpr double kMaxFrames = 1'000'000;

// A stretch of constant curvature.
struct Segment {
  Pose start;
  double length_m = 0.0;
  double curvature_per_m = 0.0;

  Pose at(double along_m) const {
    const double turned = curvature_per_m * along_m;
    if (turned == 0.0) return compose(start, {along_m, 0.0, 0.0});
    const double radius_m = 1.0 / curvature_per_m;
    return compose(start,
                   {radius_m * std::sin(turned), radius_m * (1.0 - std::cos(turned)), turned});
  }
};

using Points = std::vector<Eigen::Vector2d>;

Points sweep_points(const MissionOptions& options) {
  Points points;
  for (int leg = 0; leg < options.legs; ++leg) {
    const double y = leg * options.leg_spacing_m;
    const bool outward = leg % 2 == 0;
    points.emplace_back(outward ? 0.0 : options.leg_length_m, y);
    points.emplace_back(outward ? options.leg_length_m : 0.0, y);
  }
  return points;
}

// From the middle of the first side, as a corner could not be both rounded and passed through.
Points loop_points(const MissionOptions& options) {
  const double half = options.loop_length_m / 2.0;
  const double width = options.loop_width_m;
  return {{0, 0},         {half, 0},  {half, width},
          {-half, width}, {-half, 0}, {options.loop_overrun_m, 0}};
}

Points waypoints(const MissionOptions& options, const std::string& key) {
  const std::vector<double>& numbers = options.waypoints_m;
  if (numbers.size() < 4 || numbers.size() % 2 != 0) {
    throw InputError(key + ": expected at least two waypoints [x1, y1, x2, y2, ...]");
  }
  Points points;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    points.emplace_back(numbers[i], numbers[i + 1]);
    if (!points.back().allFinite()) throw InputError(key + ": expected finite numbers");
  }
  return points;
}

struct Polyline {
  Points points;
  std::string key;  ///< of the option that the points come from
};

Polyline polyline_of(const MissionOptions& options, const std::string& prefix) {
  switch (options.type) {
    case MissionType::kSweep:
      return {sweep_points(options), prefix + "leg_spacing_m"};
    case MissionType::kSingleLoop:
      return {loop_points(options), prefix + "loop_width_m"};
    case MissionType::kWaypoints:
      break;
  }
  return {waypoints(options, prefix + "waypoints_m"), prefix + "waypoints_m"};
}

// The polyline with its corners rounded. A corner of turn φ takes radius · tan(φ/2) off both sides.
std::vector<Segment> rounded(const Polyline& line, double radius_m, const std::string& prefix) {
  const Points& points = line.points;
  std::vector<Segment> path;
  double cut_before_m = 0.0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Eigen::Vector2d side = points[i + 1] - points[i];
    const double heading = std::atan2(side.y(), side.x());
    double turn = 0.0;
    double cut_after_m = 0.0;
    if (i + 2 < points.size()) {
      const Eigen::Vector2d next = points[i + 2] - points[i + 1];
      turn = wrap_angle(std::atan2(next.y(), next.x()) - heading);
      cut_after_m = radius_m * std::tan(std::abs(turn) / 2.0);
    }
    const double straight_m = side.norm() - cut_before_m - cut_after_m;
    // Room for rounding: a turn of radius spacing / 2 leaves exactly nothing of its side.
    if (side.norm() <= 0.0 || !(straight_m > -1e-9 * side.norm())) {
      throw InputError(line.key + ": the side from point " + std::to_string(i + 1) + " to " +
                       std::to_string(i + 2) + " is too short for its rounded corners; " +
                       "lengthen it or lower " + prefix + "turn_radius_m");
    }
    const Pose start{points[i].x(), points[i].y(), heading};
    path.push_back({compose(start, {cut_before_m, 0, 0}), std::max(straight_m, 0.0), 0.0});
    if (turn != 0.0) {
      path.push_back({compose(start, {side.norm() - cut_after_m, 0, 0}), radius_m * std::abs(turn),
                      std::copysign(1.0 / radius_m, turn)});
    }
    cut_before_m = cut_after_m;
  }
  return path;
}

}  // namespace

void MissionOptions::describe(OptionTable& table) {
  table.enumeration("type", type,
                    {{"sweep", MissionType::kSweep},
                     {"single_loop", MissionType::kSingleLoop},
                     {"waypoints", MissionType::kWaypoints}},
                    "shape of the path");
  table.integer("legs", legs, Range::between(1, 10'000), "", "sweep: number of legs");
  table.real("leg_length_m", leg_length_m, Range::positive(), "m", "sweep: length of a leg");
  table.real("leg_spacing_m", leg_spacing_m, Range::positive(), "m", "sweep: between two legs");
  table.real("loop_length_m", loop_length_m, Range::positive(), "m",
             "single_loop: the side that starts it");
  table.real("loop_width_m", loop_width_m, Range::positive(), "m", "single_loop: the other side");
  table.real("loop_overrun_m", loop_overrun_m, Range::at_least(0), "m",
             "single_loop: how far it goes on past its start");
  table.reals("waypoints_m", waypoints_m, 2, "m",
              "waypoints: [x1, y1, x2, y2, ...], shifted and turned so that the first leg is x");
  table.real("turn_radius_m", turn_radius_m, Range::positive(), "m", "radius of rounded corners");
  table.real("speed_m_s", speed_m_s, Range::positive(), "m/s", "speed along the path");
  table.real("frame_rate_hz", frame_rate_hz, Range::positive(), "Hz", "pictures per second");
}

std::vector<IgnoredKey> MissionOptions::ignored_keys() const {
  const std::pair<MissionType, std::vector<const char*>> own_keys[] = {
      {MissionType::kSweep, {"legs", "leg_length_m", "leg_spacing_m"}},
      {MissionType::kSingleLoop, {"loop_length_m", "loop_width_m", "loop_overrun_m"}},
      {MissionType::kWaypoints, {"waypoints_m"}}};
  std::vector<IgnoredKey> ignored;
  for (const auto& [other, keys] : own_keys) {
    if (other == type) continue;
    for (const char* key : keys) ignored.push_back({key, "type"});
  }
  return ignored;
}

std::vector<StampedPose> fly_mission(const MissionOptions& options, const std::string& prefix) {
  const Polyline line = polyline_of(options, prefix);
  const std::vector<Segment> path = rounded(line, options.turn_radius_m, prefix);
  double length_m = 0.0;
  for (const Segment& segment : path) length_m += segment.length_m;
  const double last =
      std::floor(length_m / options.speed_m_s * options.frame_rate_hz * (1 + 1e-12));
  if (!(last < kMaxFrames)) {
    throw InputError(fmt::format(
        "{0}frame_rate_hz: the mission would have {1:.0f} frames, at most 1000000 are possible; "
        "lower it or raise {0}speed_m_s",
        prefix, last));
  }
  std::vector<StampedPose> poses;
  std::size_t current = 0;
  double segment_start_m = 0.0;
  for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
    const auto time_ns = static_cast<std::int64_t>(
        std::llround(static_cast<double>(i) * 1e9 / options.frame_rate_hz));
    const double along_m = options.speed_m_s * 1e-9 * static_cast<double>(time_ns);
    while (current + 1 < path.size() && along_m > segment_start_m + path[current].length_m) {
      segment_start_m += path[current++].length_m;
    }
    const Pose pose = path[current].at(along_m - segment_start_m);
    poses.push_back({time_ns, between(path.front().start, pose)});
  }
  return poses;
}

}  // namespace fathom
