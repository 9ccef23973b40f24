#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/geometry/trajectory.hpp"

namespace fathom {

/// The pose of a camera of another tool, in its world: where it is and its axes, x to the right of
/// the picture, y down, z along the optical axis.
struct CameraPose {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns x, y, z
};

/// Cameras that look down, in the plane that fits their centres best.
struct PlanarCameras {
  /// x forward, y to port; the first is the origin. In the units of the model.
  std::vector<Pose> poses;
  double rms_off_plane = 0.0;  ///< of the centres, in the units of the model
  double most_tilt_rad = 0.0;  ///< of an optical axis against the plane's normal
  double median_tilt_rad = 0.0;
  bool is_normal_by_view = false;  ///< the centres lie along a line: by the optical axes alone
};

/// `cameras` is not empty. The plane's upper side is the one that the cameras lie on, looking down,
/// so that no map is mirrored. A camera's forward is the top of its picture.
PlanarCameras project_to_plane(const std::vector<CameraPose>& cameras);

/// The survey that poses are of: an image folder, or plain pictures. Of the latter nothing but
/// names and times is known: those of EXIF, or those of a run with the default interval_s, which
/// a note says.
std::unique_ptr<const FrameSource> open_pictures_of(const std::filesystem::path& survey,
                                                    std::vector<std::string>& notes);

/// Writes `folder`/state_groundtruth_estimate0 and `folder`/reference.tum. Throws InputError.
void write_reference_poses(const std::vector<StampedPose>& poses,
                           const std::filesystem::path& folder);

}  // namespace fathom
