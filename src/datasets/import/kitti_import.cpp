#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "pose_table.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

// The camera looks ahead: z is forward, x to starboard and y down.
Pose on_plane(const SpatialPose& pose) {
  const Eigen::Vector3d forward = pose.rotation.normalized() * Eigen::Vector3d::UnitZ();
  return {pose.position_m.z(), -pose.position_m.x(), std::atan2(-forward.x(), forward.z())};
}

std::vector<std::int64_t> times_of(const fs::path& poses, const PoseImportOptions& options,
                                   std::vector<std::string>& notes) {
  if (!options.times.empty()) return read_times(options.times);
  if (options.survey.empty()) {
    throw InputError(poses.string(),
                     "KITTI poses have no times; --times FILE has them in seconds, one a line, or "
                     "--survey DIR has the pictures that they are of, in their order");
  }
  const auto survey = open_pictures_of(options.survey, notes);
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < survey->size(); ++i) times.push_back(survey->info(i).time_ns);
  return times;
}

}  // namespace

ImportReport import_kitti(const fs::path& path, const PoseImportOptions& options,
                          const fs::path& folder) {
  const std::vector<SpatialPose> poses = read_kitti_poses(path);
  ImportReport report;
  const std::vector<std::int64_t> times = times_of(path, options, report.notes);
  if (times.size() != poses.size()) {
    throw InputError(path.string(),
                     fmt::format("has {} poses for {} times", poses.size(), times.size()));
  }
  std::vector<StampedPose> reference;
  double most_height = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Pose pose = on_plane(poses[i]);
    reference.push_back({times[i], {pose.x * options.scale, pose.y * options.scale, pose.theta}});
    most_height = std::max(most_height, std::abs(poses[i].position_m.y()) * options.scale);
  }
  write_reference_poses(reference, folder);
  report.facts.push_back(std::to_string(reference.size()) +
                         " poses, in the plane of z (forward) and x (to starboard)");
  report.facts.push_back("height left out: at most " + short_number(most_height) +
                         " m from the origin");
  return report;
}

}  // namespace fathom
