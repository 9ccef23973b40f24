#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/datasets/odometry_rows.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/shared_errors.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// All that is known of one frame but its picture.
struct FrameInfo {
  std::int64_t time_ns = 0;
  double altitude_m = 0.0;  ///< as measured, of the camera's centre over the floor, vertical; > 0
  /// Dead reckoning: the motion since the frame before, in that frame, with its covariance. Absent
  /// at the first frame, and where the source has no odometry.
  std::optional<UncertainPose> motion;
  std::optional<Pose> ground_truth = std::nullopt;
  /// Roll and pitch as measured. Absent where the source has none: a camera is taken for level
  /// then.
  std::optional<MeasuredTilt> tilt = std::nullopt;

  /// Whether nothing was measured of the motion: it is a guess then, with a declared covariance.
  bool is_hole = false;
  /// Of the altitude, as its sensor states it; 0: it states none.
  double altitude_sigma_m = 0.0;
  /// Of a motion that is a registration: what it shares with others of the picture of the frame
  /// before and of this one, a part of its covariance. Null: nothing.
  std::shared_ptr<const SharedErrors> motion_errors = nullptr;

  Stance stance() const { return {altitude_m, tilt}; }
};

/// Where the set-up of its sensors is written, for those who advise what to write.
struct SetUpFiles {
  bool are_sensor_yaml = false;  ///< a sensor.yaml beside each sensor; else keys of the data set
  double altimeter_scale = 1.0;  ///< that altitudes have been multiplied by
};

/// A recorded or simulated survey: frames in the order of time.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  virtual const Camera& camera() const = 0;
  virtual std::size_t size() const = 0;

  /// Frame i < size(); cheap. The reference holds as long as the source does.
  virtual const FrameInfo& info(std::size_t i) const = 0;

  /// The picture of frame i, 8-bit, one channel. May be called from several threads at once.
  /// Throws InputError naming the file where it is missing, unreadable or of the wrong size.
  virtual cv::Mat image(std::size_t i) const = 0;

  /// Tells pictures apart without decoding or rendering one: the same number means the same pixels,
  /// in whatever source and run. May be called from several threads at once. Throws InputError
  /// naming the file where it is missing or unreadable.
  virtual std::uint64_t picture_id(std::size_t i) const = 0;

  /// What of its pictures is no floor: CV_8U, of their size, 0 there; empty: it is not known.
  virtual cv::Mat given_mask() const { return {}; }

  /// What the picture of frame i is called: its file, where it has one.
  virtual std::string picture_name(std::size_t i) const { return "frame " + std::to_string(i); }

  /// Whether every frame has its roll and pitch; else none has.
  bool has_attitude() const { return size() > 0 && info(0).tilt.has_value(); }

  /// Whether every frame after the first has its motion.
  virtual bool has_odometry() const = 0;
  virtual bool has_ground_truth() const = 0;

  /// Dead reckoning as its sensor gives it; by default the frames' motions, composed. Asks for all
  /// of them. Without rows where there is no odometry.
  virtual RecordedOdometry recorded_odometry() const;

  virtual SetUpFiles set_up_files() const { return {}; }

  /// Whether a frame's motion is the registration of its picture with the one before.
  virtual bool is_visual_odometry() const { return false; }
};

}  // namespace fathom
