#include <array>
#include <cmath>
#include <sstream>
#include <string>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/import.hpp"
#include "pose_table.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

struct KittiPoses {
  std::vector<Pose> planar;
  double most_height = 0.0;  ///< of the heights that the plane leaves out, from the first
};

std::vector<std::string> data_lines(const fs::path& path) {
  std::istringstream text(read_text(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  while (!lines.empty() && trim(lines.back()).empty()) lines.pop_back();
  if (lines.empty()) throw InputError(path.string(), "is empty");
  return lines;
}

// A line is the upper three rows of the camera's pose, row by row. The camera looks ahead: z is
// forward, x to starboard and y down.
KittiPoses read_poses(const fs::path& path) {
  constexpr std::size_t kNumbers = 12;
  KittiPoses poses;
  std::size_t number = 0;
  for (const std::string& line : data_lines(path)) {
    ++number;
    const auto words = split(line);
    std::array<double, kNumbers> m{};
    bool is_pose = words.size() == kNumbers;
    for (std::size_t i = 0; is_pose && i < kNumbers; ++i) {
      const auto value = parse_real(words[i]);
      is_pose = value.has_value();
      if (value) m[i] = *value;
    }
    // Forward in the world is the third column.
    const double length = std::sqrt(m[2] * m[2] + m[6] * m[6] + m[10] * m[10]);
    if (!is_pose || std::abs(length - 1.0) > 0.02) {
      throw InputError(path.string(), number,
                       "expected 12 numbers, the first three rows of a pose with a rotation in it");
    }
    poses.planar.push_back({m[11], -m[3], std::atan2(-m[2], m[10])});
    poses.most_height = std::max(poses.most_height, std::abs(m[7]));
  }
  return poses;
}

std::vector<std::int64_t> read_times(const fs::path& path) {
  constexpr double kNsPerSecond = 1e9;
  std::vector<std::int64_t> times;
  std::size_t number = 0;
  for (const std::string& line : data_lines(path)) {
    ++number;
    const auto seconds = parse_real(trim(line));
    // Beyond that a count of nanoseconds does not hold it: it is one itself.
    if (!seconds || std::abs(*seconds) > 9e9) {
      throw InputError(path.string(), number, "expected a time in seconds");
    }
    times.push_back(std::llround(*seconds * kNsPerSecond));
    if (times.size() > 1 && times.back() <= times[times.size() - 2]) {
      throw InputError(path.string(), number, "does not come after the time before");
    }
  }
  return times;
}

std::vector<std::int64_t> times_of(const fs::path& poses, const PoseImportOptions& options) {
  if (!options.times.empty()) return read_times(options.times);
  if (options.survey.empty()) {
    throw InputError(poses.string(),
                     "KITTI poses have no times; --times FILE has them in seconds, one a line, or "
                     "--survey DIR has the pictures that they are of, in their order");
  }
  const ImageFolder survey(options.survey);
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < survey.size(); ++i) times.push_back(survey.info(i).time_ns);
  return times;
}

}  // namespace

ImportReport import_kitti(const fs::path& path, const PoseImportOptions& options,
                          const fs::path& folder) {
  const KittiPoses poses = read_poses(path);
  const std::vector<std::int64_t> times = times_of(path, options);
  if (times.size() != poses.planar.size()) {
    throw InputError(path.string(), "has " + std::to_string(poses.planar.size()) + " poses for " +
                                        std::to_string(times.size()) + " times");
  }
  std::vector<StampedPose> reference;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Pose& pose = poses.planar[i];
    reference.push_back({times[i], {pose.x * options.scale, pose.y * options.scale, pose.theta}});
  }
  write_reference_poses(reference, folder);
  ImportReport report;
  report.facts.push_back(std::to_string(reference.size()) +
                         " poses, in the plane of z (forward) "
                         "and x (to starboard)");
  report.facts.push_back("height left out: at most " +
                         short_number(poses.most_height * options.scale) + " m from the origin");
  return report;
}

}  // namespace fathom
