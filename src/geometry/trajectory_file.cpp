#include "fathom/geometry/trajectory_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/geometry/quaternion_order.hpp"
#include "trajectory_lines.hpp"
#include "trajectory_times.hpp"

namespace fathom {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

using Lines = std::vector<LineOfFile>;

// Commas are EuRoC's, and those of TUM where any of the stamps has a fraction, as seconds have.
TrajectoryFormat with_commas(const Lines& lines) {
  constexpr std::size_t kTumFields = 8;
  constexpr double kLatest = 9e9;
  const auto is_in_seconds = [](const LineOfFile& line) {
    const auto fields = split_csv(line.text());
    const auto stamp = parse_real(fields.front());
    return fields.size() == kTumFields && stamp && std::abs(*stamp) < kLatest &&
           *stamp != std::floor(*stamp);
  };
  return std::any_of(lines.begin(), lines.end(), is_in_seconds) ? TrajectoryFormat::tum
                                                                : TrajectoryFormat::euroc;
}

TrajectoryFormat recognised(const Lines& lines) {
  if (lines.empty()) return TrajectoryFormat::tum;
  const LineOfFile& line = lines.front();
  if (has_commas(line)) return with_commas(lines);
  const std::size_t fields = split(line.text()).size();
  if (fields == 12) return TrajectoryFormat::kitti;
  if (fields == 8) return TrajectoryFormat::tum;
  line.refuse(
      "a line of a trajectory has 8 values (TUM), 12 (KITTI) or 8 and more with commas "
      "(EuRoC), got " +
      std::to_string(fields));
}

template <class Read>
std::vector<StampedSpatialPose> read_all(const Lines& lines, const Read& read) {
  std::vector<StampedSpatialPose> poses;
  poses.reserve(lines.size());
  for (const LineOfFile& line : lines) poses.push_back(read(line));
  return poses;
}

void require_rising_poses(const Lines& lines, const std::vector<StampedSpatialPose>& poses,
                          const StampRule& rule) {
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(poses.size());
  for (const StampedSpatialPose& pose : poses) times_ns.push_back(pose.time_ns);
  require_rising(lines, times_ns, rule);
}

std::vector<StampedSpatialPose> read_tum(const Lines& lines, const std::string& name) {
  const bool commas = !lines.empty() && has_commas(lines.front());
  auto poses = read_all(lines, [&](const LineOfFile& line) { return tum_pose(line, commas); });
  require_rising_poses(lines, poses,
                       {1.0, commas ? "LC_ALL=C sort -s -t , -k1,1g" : "LC_ALL=C sort -s -k1,1g"});
  require_order(poses, TrajectoryFormat::tum, name);
  return poses;
}

// Nothing that moves is known more than 10 000 times a second: such time stamps are of another
// unit.
void require_nanoseconds(const std::vector<StampedSpatialPose>& poses, const std::string& name) {
  constexpr std::uint64_t kLeastStep = 100'000;
  if (poses.size() < 2 || poses.back().time_ns <= poses.front().time_ns) return;
  // They may be further apart than a signed difference can tell.
  const std::uint64_t span_ns = static_cast<std::uint64_t>(poses.back().time_ns) -
                                static_cast<std::uint64_t>(poses.front().time_ns);
  const std::uint64_t step_ns = span_ns / (poses.size() - 1);
  if (step_ns >= kLeastStep) return;
  throw InputError(name, "the time stamps are " + std::to_string(step_ns) +
                             " ns apart; an EuRoC file has whole nanoseconds, 1 s is 1000000000; "
                             "--from tum reads commas, seconds and qx, qy, qz, qw");
}

std::vector<StampedSpatialPose> read_euroc(const Lines& lines, const std::string& name) {
  if (!lines.empty()) has_commas(lines.front());
  auto poses = read_all(lines, euroc_pose);
  require_nanoseconds(poses, name);
  require_rising_poses(lines, poses, {1e-9, "LC_ALL=C sort -s -t , -k1,1g"});
  require_order(poses, TrajectoryFormat::euroc, name);
  return poses;
}

std::vector<std::int64_t> times_of_kitti(const TrajectorySource& source, const Lines& lines) {
  std::vector<std::int64_t> times_ns;
  if (source.times.empty()) {
    for (std::size_t k = 0; k < lines.size(); ++k) {
      times_ns.push_back(static_cast<std::int64_t>(k) * kSecond);
    }
    return times_ns;
  }
  times_ns = read_times(source.times);
  if (times_ns.size() == lines.size()) return times_ns;
  throw InputError(source.times.string(),
                   fmt::format("has {} time stamps, {} {} poses", times_ns.size(),
                               source.path.string(), lines.size()));
}

std::vector<StampedSpatialPose> read_kitti(const TrajectorySource& source, const Lines& lines) {
  const std::vector<std::int64_t> times_ns = times_of_kitti(source, lines);
  std::vector<StampedSpatialPose> poses;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    poses.push_back({times_ns[k], kitti_pose(lines[k])});
  }
  return poses;
}

}  // namespace

const std::vector<std::pair<std::string, TrajectoryFormat>>& trajectory_format_names() {
  static const std::vector<std::pair<std::string, TrajectoryFormat>> names{
      {"tum", TrajectoryFormat::tum},
      {"kitti", TrajectoryFormat::kitti},
      {"euroc", TrajectoryFormat::euroc}};
  return names;
}

std::string title_of(TrajectoryFormat format) {
  if (format == TrajectoryFormat::kitti) return "KITTI";
  return format == TrajectoryFormat::tum ? "TUM" : "EuRoC";
}

SpatialTrajectory read_trajectory(const TrajectorySource& source) {
  const std::string name = source.path.string();
  const std::string content = read_text(source.path);
  const Lines lines = trajectory_lines(content, name);
  SpatialTrajectory trajectory;
  trajectory.format = source.format ? *source.format : recognised(lines);
  const bool is_kitti = trajectory.format == TrajectoryFormat::kitti;
  if (!source.times.empty() && !is_kitti) {
    throw InputError(name, fmt::format("is a {} trajectory, which has times of its own; {} can be "
                                       "for a KITTI trajectory alone",
                                       title_of(trajectory.format), source.times.string()));
  }
  if (trajectory.format == TrajectoryFormat::tum) {
    trajectory.poses = read_tum(lines, name);
  } else if (is_kitti) {
    trajectory.poses = read_kitti(source, lines);
    trajectory.has_times = !source.times.empty();
  } else {
    trajectory.poses = read_euroc(lines, name);
    if (!lines.empty()) trajectory.further_columns = split_csv(lines.front().text()).size() - 8;
  }
  return trajectory;
}

std::vector<SpatialPose> read_kitti_poses(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string content = read_text(path);
  std::vector<SpatialPose> poses;
  for (const LineOfFile& line : trajectory_lines(content, name)) poses.push_back(kitti_pose(line));
  return poses;
}

std::vector<std::int64_t> read_times(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string content = read_text(path);
  std::vector<std::int64_t> times_ns;
  const Lines lines = trajectory_lines(content, name);
  for (const LineOfFile& line : lines) {
    if (split(line.text()).size() != 1) line.refuse("expected one time stamp, in seconds");
    times_ns.push_back(time_of(line, line.text()));
  }
  // In order with the poses of another file: sorted alone they would be those of other poses.
  require_rising(lines, times_ns, {1.0, ""});
  return times_ns;
}

double yaw_of(const Eigen::Quaterniond& q) {
  return wrap_angle(std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                               q.squaredNorm() - 2.0 * (q.y() * q.y() + q.z() * q.z())));
}

}  // namespace fathom
