#include "fathom/geometry/trajectory.hpp"

#include <cmath>
#include <numeric>

#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

std::vector<std::size_t> consecutive(std::size_t begin, std::size_t end) {
  std::vector<std::size_t> keyframes(end - begin);
  std::iota(keyframes.begin(), keyframes.end(), begin);
  return keyframes;
}

// Its revision is its length.
MovedPoses GivenTrajectory::moved_since(std::uint64_t revision) const {
  return {poses_.size(), consecutive(revision, poses_.size())};
}

std::vector<Pose> poses_of(const TrajectoryView& view) {
  std::vector<Pose> poses;
  poses.reserve(view.size());
  for (std::size_t k = 0; k < view.size(); ++k) poses.push_back(view.pose(k));
  return poses;
}

std::vector<Pose> compose_trajectory(const Pose& origin, std::span<const Pose> motions) {
  std::vector<Pose> poses{origin};
  poses.reserve(motions.size() + 1);
  for (const Pose& motion : motions) poses.push_back(compose(poses.back(), motion));
  return poses;
}

std::string to_tum(std::span<const StampedPose> trajectory) {
  std::string text = "# t x y z qx qy qz qw\n";
  for (const StampedPose& stamped : trajectory) {
    const Pose& pose = stamped.pose;
    text += seconds_text(stamped.time_ns) + ' ' + exact(pose.x) + ' ' + exact(pose.y) + " 0 0 0 " +
            exact(std::sin(pose.theta / 2)) + ' ' + exact(std::cos(pose.theta / 2)) + '\n';
  }
  return text;
}

std::vector<StampedPose> read_tum(const std::filesystem::path& path) {
  std::vector<StampedPose> trajectory;
  for (const auto& [time_ns, pose] : read_trajectory({path, TrajectoryFormat::tum, {}}).poses) {
    trajectory.push_back(
        {time_ns, {pose.position_m.x(), pose.position_m.y(), yaw_of(pose.rotation)}});
  }
  return trajectory;
}

}  // namespace fathom
