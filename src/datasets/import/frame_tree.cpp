#include "frame_tree.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// Early versions of tf begin names with a slash.
std::string plain_frame(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

// Nothing of one that is no rotation.
std::optional<Eigen::Isometry3d> isometry_of(const FrameTransform& transform) {
  const double norm = transform.rotation.norm();
  if (!transform.translation.allFinite() || !(std::abs(norm - 1.0) < 1e-2)) return std::nullopt;
  return Eigen::Translation3d(transform.translation) * transform.rotation.normalized();
}

}  // namespace

std::vector<std::size_t> transform_topics(const std::vector<BagTopic>& topics,
                                          const BagImportOptions& options) {
  const bool is_given = options.mount_x_m || options.mount_y_m || options.mount_yaw_rad ||
                        !options.camera_yaml.empty();
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < topics.size() && !is_given; ++i) {
    const BagTopic& topic = topics[i];
    if (topic.type != "tf2_msgs/TFMessage" && topic.type != "tf/tfMessage") continue;
    if (topic.md5.empty() || topic.md5 == *known_md5(topic.type)) found.push_back(i);
  }
  return found;
}

void FrameTree::take(const std::vector<FrameTransform>& transforms) {
  constexpr std::size_t kMostFrames = 10'000;
  constexpr double kSame = 1e-9;
  for (const FrameTransform& transform : transforms) {
    const auto in_parent = isometry_of(transform);
    if (!in_parent) continue;
    const std::string parent = plain_frame(transform.parent);
    const auto [place, is_new] =
        nodes_.try_emplace(plain_frame(transform.child), Node{parent, *in_parent});
    Node& node = place->second;
    if (node.parent != parent || !node.in_parent.isApprox(*in_parent, kSame)) {
      node.is_static = false;
    }
    if (nodes_.size() > kMostFrames) {
      throw InputError("has more than " + std::to_string(kMostFrames) + " frames");
    }
  }
}

std::map<std::string, Eigen::Isometry3d> FrameTree::above(const std::string& frame) const {
  std::map<std::string, Eigen::Isometry3d> poses;
  std::string at = frame;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  // A frame that is met again closes a loop.
  while (poses.emplace(at, pose).second) {
    const auto node = nodes_.find(at);
    if (node == nodes_.end() || !node->second.is_static) break;
    pose = node->second.in_parent * pose;
    at = node->second.parent;
  }
  return poses;
}

std::optional<Mounting> FrameTree::mounting(const std::string& camera,
                                            const std::string& body) const {
  const auto of_camera = above(plain_frame(camera));
  for (const auto& [frame, body_in_frame] : above(plain_frame(body))) {
    const auto common = of_camera.find(frame);
    if (common == of_camera.end()) continue;
    // Whatever frame above both is taken, the ways to it from there are the same.
    const Eigen::Isometry3d in_body = body_in_frame.inverse() * common->second;
    const Eigen::Vector3d axis = in_body.linear().col(2);
    const Eigen::Vector3d top = -in_body.linear().col(1);
    return Mounting{
        {in_body.translation().x(), in_body.translation().y(), std::atan2(top.y(), top.x())},
        std::acos(std::clamp(-axis.z(), -1.0, 1.0))};
  }
  return std::nullopt;
}

std::optional<Pose> mounting_by_tf(const FrameTree& frames, const std::string& camera,
                                   const std::string& body, std::vector<std::string>& notes) {
  constexpr double kMostTilt_rad = 0.35;  // beyond it looks elsewhere than down
  constexpr double kLevel_rad = 0.01;
  if (frames.is_empty()) return std::nullopt;
  std::string in = body;
  auto mounting = frames.mounting(camera, in);
  if (!mounting) {
    in = "base_link";
    mounting = frames.mounting(camera, in);
  }
  const std::string name = in_quotes(camera);
  if (!mounting) {
    notes.push_back("tf does not say where the camera's frame " + name + " is in the body, " +
                    in_quotes(body.empty() ? in : body));
    return std::nullopt;
  }
  const std::string tilt = short_number(mounting->tilt_rad) + " rad off straight down";
  if (mounting->tilt_rad > kMostTilt_rad) {
    notes.push_back("the mounting in tf is not taken: by it the z axis of " + name + " points " +
                    tilt);
    return std::nullopt;
  }
  const Pose& mount = mounting->pose;
  notes.push_back(fmt::format(
      "mounting of the camera from tf, {} in {}: x {} m, y {} m, yaw {} rad{}", name, in_quotes(in),
      short_number(mount.x, 4), short_number(mount.y, 4), short_number(mount.theta, 4),
      mounting->tilt_rad > kLevel_rad ? "; taken for level, it is " + tilt : ""));
  return mount;
}

}  // namespace fathom
