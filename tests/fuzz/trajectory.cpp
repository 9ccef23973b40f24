// A file with a trajectory, of a format that is told by its content or named: read, written, read
// again, and compared with itself.
#include "fathom/evaluation/alignment.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "support/fuzz.hpp"

namespace {

using namespace fathom;

std::vector<StampedPose> in_plane(const SpatialTrajectory& trajectory) {
  std::vector<StampedPose> poses;
  for (const auto& [time_ns, pose] : trajectory.poses) {
    poses.push_back({time_ns, {pose.position_m.x(), pose.position_m.y(), yaw_of(pose.rotation)}});
  }
  return poses;
}

void look_at(const SpatialTrajectory& trajectory, const fuzz::Folder& folder) {
  const auto format = trajectory.format;
  const std::string written = to_text(trajectory.poses, format);
  if (format != TrajectoryFormat::kitti) {
    const auto again = read_trajectory({folder.write("written", written), format, {}});
    fuzz::require(to_text(again.poses, format) == written, "it reads back as it was written");
  }
  const std::vector<StampedPose> poses = in_plane(trajectory);
  const std::vector<PosePair> pairs = associate(poses, poses, 0.01);
  fuzz::require(pairs.size() == poses.size(), "every pose belongs to itself");
  const AssociatedPoses both = paired_poses(poses, poses, pairs);
  for (const auto& [name, alignment] : alignment_names()) {
    align(both.estimate, both.reference, alignment);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder("trajectory");
  const std::filesystem::path file = folder.write("trajectory", fuzz::text_of(data, size));
  std::vector<std::optional<TrajectoryFormat>> formats{std::nullopt};
  for (const auto& [name, format] : trajectory_format_names()) formats.emplace_back(format);
  for (const auto& format : formats) {
    SpatialTrajectory trajectory;
    if (fuzz::is_taken([&] { trajectory = read_trajectory({file, format, {}}); })) {
      look_at(trajectory, folder);
    }
  }
  fuzz::is_taken([&] { read_times(file); });
  return 0;
}
