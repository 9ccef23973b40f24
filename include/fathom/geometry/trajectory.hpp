#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fathom/geometry/covariance.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Poses that may have changed since an earlier revision of a trajectory.
struct MovedPoses {
  std::uint64_t revision = 0;  ///< of the trajectory as it is
  /// Those that moved, and those that are new, in any order; absent: any may have moved.
  std::optional<std::vector<std::size_t>> keyframes;
};

/// begin … end − 1.
std::vector<std::size_t> consecutive(std::size_t begin, std::size_t end);

/// Read-only view of an estimate: the poses of all keyframes so far, in the world frame.
class TrajectoryView {
 public:
  virtual ~TrajectoryView() = default;
  virtual std::size_t size() const = 0;
  /// k < size().
  virtual Pose pose(std::size_t k) const = 0;

  /// What changed since `revision`, a number that this call gave earlier, or 0 for everything.
  virtual MovedPoses moved_since(std::uint64_t revision) const {
    (void)revision;
    return {};
  }

  /// The motion ⊖X_k ⊕ X_n to the newest keyframe n from every earlier keyframe k, size() − 1 of
  /// them, with the covariance of its (x, y, θ) in the axes of k: first order at the estimate, the
  /// correlation of both poses counted. All at once, as that costs little more than one. Nothing
  /// where no covariances are known.
  virtual std::optional<std::vector<UncertainPose>> motions_to_newest() const {
    return std::nullopt;
  }
};

/// A trajectory that is given, without covariances: ground truth, or dead reckoning.
class GivenTrajectory : public TrajectoryView {
 public:
  GivenTrajectory() = default;
  explicit GivenTrajectory(std::vector<Pose> poses) : poses_(std::move(poses)) {}
  void append(const Pose& pose) { poses_.push_back(pose); }
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  MovedPoses moved_since(std::uint64_t revision) const override;

 private:
  std::vector<Pose> poses_;
};

struct StampedPose {
  /// Nanoseconds; of a pose graph, the vertex id in whole seconds.
  std::int64_t time_ns = 0;
  Pose pose;
};

/// The poses of a whole view, in order.
std::vector<Pose> poses_of(const TrajectoryView& view);

/// Composes motions from `origin` on: one pose more than motions.
std::vector<Pose> compose_trajectory(const Pose& origin, std::span<const Pose> motions);

/// A trajectory in TUM format, `t x y z qx qy qz qw` a line with t in seconds, z = 0 and the
/// heading as a rotation about z. Numbers read back to the same bits, but for the heading, which
/// goes through half-angle sine and cosine (1e-16 relative).
std::string to_tum(std::span<const StampedPose> trajectory);

/// Reads a TUM file; `#` opens a comment. The heading is the yaw of the quaternion. Throws
/// InputError with file and line on a malformed line, a quaternion far from unit length, or time
/// that does not rise.
std::vector<StampedPose> read_tum(const std::filesystem::path& path);

}  // namespace fathom
