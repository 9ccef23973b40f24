#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "bag.hpp"
#include "bag_messages.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Topics of tf that are read for the camera's mounting: none where a flag or a sensor.yaml says
/// it, or where a message has another definition than the one that is read.
std::vector<std::size_t> transform_topics(const std::vector<BagTopic>& topics,
                                          const BagImportOptions& options);

/// How a camera that looks down is mounted.
struct Mounting {
  Pose pose;            ///< as mount_x, mount_y and mount_yaw of CameraModel
  double tilt_rad = 0;  ///< of its axis against straight down
};

/// The frames of tf. Those whose transform never changes are static, whatever topic says them.
class FrameTree {
 public:
  /// Throws InputError beyond 10 000 frames.
  void take(const std::vector<FrameTransform>& transforms);

  bool is_empty() const { return nodes_.empty(); }

  /// Of an optical frame (z along the axis of the camera, x to the right of its picture) in a body,
  /// by static transforms alone; nothing where they do not join the two.
  std::optional<Mounting> mounting(const std::string& camera, const std::string& body) const;

 private:
  struct Node {
    std::string parent;
    Eigen::Isometry3d in_parent;
    bool is_static = true;
  };
  /// The pose of a frame in each one above it, itself included.
  std::map<std::string, Eigen::Isometry3d> above(const std::string& frame) const;

  std::map<std::string, Node> nodes_;
};

/// mount_x, mount_y and mount_yaw of the camera's frame in the body's, else in base_link; nothing
/// without a chain of static transforms, or where the camera does not look down. Unless there is no
/// tf at all, a note says what is taken or why it is not.
std::optional<Pose> mounting_by_tf(const FrameTree& frames, const std::string& camera,
                                   const std::string& body, std::vector<std::string>& notes);

}  // namespace fathom
