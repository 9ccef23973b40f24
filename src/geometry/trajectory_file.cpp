#include "fathom/geometry/trajectory_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/pose.hpp"
#include "trajectory_lines.hpp"

namespace fathom {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

using Lines = std::vector<LineOfFile>;

TrajectoryFormat recognised(const LineOfFile& line) {
  if (line.text().find(',') != std::string_view::npos) return TrajectoryFormat::euroc;
  const std::size_t fields = split(line.text()).size();
  if (fields == 12) return TrajectoryFormat::kitti;
  if (fields == 8) return TrajectoryFormat::tum;
  line.refuse(
      "a line of a trajectory has 8 values (TUM), 12 (KITTI) or 8 and more with commas "
      "(EuRoC), got " +
      std::to_string(fields));
}

template <class Read>
std::vector<StampedSpatialPose> rising(const Lines& lines, const Read& read,
                                       const std::string& remedy) {
  std::vector<StampedSpatialPose> poses;
  for (const LineOfFile& line : lines) {
    poses.push_back(read(line));
    if (poses.size() > 1 && poses.back().time_ns <= poses[poses.size() - 2].time_ns) {
      line.refuse("time stamps must rise from line to line; " + remedy +
                  " orders them and keeps one of each");
    }
  }
  return poses;
}

// Nothing that moves is known more than 10 000 times a second: such time stamps are of another
// unit.
void require_nanoseconds(const std::vector<StampedSpatialPose>& poses, const std::string& name) {
  constexpr std::uint64_t kLeastStep = 100'000;
  if (poses.size() < 2) return;
  // They rise, and may be further apart than a signed difference can tell.
  const std::uint64_t span_ns = static_cast<std::uint64_t>(poses.back().time_ns) -
                                static_cast<std::uint64_t>(poses.front().time_ns);
  const std::uint64_t step_ns = span_ns / (poses.size() - 1);
  if (step_ns >= kLeastStep) return;
  throw InputError(name, "the time stamps are " + std::to_string(step_ns) +
                             " ns apart; an EuRoC file has whole nanoseconds, 1 s is 1000000000");
}

std::vector<StampedSpatialPose> read_euroc(const Lines& lines, const std::string& name) {
  auto poses = rising(lines, euroc_pose, "sort -u -t , -k1,1n");
  require_nanoseconds(poses, name);
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
  const Lines lines = lines_of(content, name);
  SpatialTrajectory trajectory;
  trajectory.format = source.format   ? *source.format
                      : lines.empty() ? TrajectoryFormat::tum
                                      : recognised(lines.front());
  const bool is_kitti = trajectory.format == TrajectoryFormat::kitti;
  if (!source.times.empty() && !is_kitti) {
    throw InputError(name, fmt::format("is a {} trajectory, which has times of its own; {} can be "
                                       "for a KITTI trajectory alone",
                                       title_of(trajectory.format), source.times.string()));
  }
  if (trajectory.format == TrajectoryFormat::tum) {
    trajectory.poses = rising(lines, tum_pose, "sort -u -k1,1n");
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
  for (const LineOfFile& line : lines_of(content, name)) poses.push_back(kitti_pose(line));
  return poses;
}

std::vector<std::int64_t> read_times(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::string content = read_text(path);
  std::vector<std::int64_t> times_ns;
  for (const LineOfFile& line : lines_of(content, name)) {
    if (split(line.text()).size() != 1) line.refuse("expected one time stamp, in seconds");
    times_ns.push_back(time_of(line, line.text()));
    if (times_ns.size() > 1 && times_ns.back() <= times_ns[times_ns.size() - 2]) {
      line.refuse("time stamps must rise from line to line");
    }
  }
  return times_ns;
}

double yaw_of(const Eigen::Quaterniond& q) {
  return wrap_angle(std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                               q.squaredNorm() - 2.0 * (q.y() * q.y() + q.z() * q.z())));
}

}  // namespace fathom
