#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/datasets/file_ids.hpp"
#include "fathom/datasets/folder_sensors.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/odometry_gaps.hpp"

namespace fathom {

class SensorCsv;
class TimeLine;

/// A recorded survey in the EuRoC/ASL folder layout (docs/formats.md).
///
/// Frames are the rows of `cam0/data.csv`. Other sensors may run at other rates: a reading with a
/// picture's own time stamp is taken as it is, else the two around it are interpolated, if they are
/// no further apart than `kMaxInterpolationGapNs`.
/// Readings that others contradict are left out (sensor_outliers.hpp), with a remark.
/// - `altimeter0`: needed at every picture; its `sensor.yaml` may state the precision of altitudes.
/// - `attitude0`: optional, else needed at every picture.
/// - `odometry0`: optional, else needed at every picture. The covariance of a frame's motion is
///   composed of the steps since the frame before; of a step cut by a picture, each part takes its
///   share of the covariance by time. Where it stops a motion is a hole, if OdometryGaps says so.
/// Where `sensor.yaml` of one of the three says how far its clock is off, pictures before its first
/// reading and after its last one are left out.
/// - `compass0`, `position0`: optional, at any rate (read_folder_sensors).
/// - `cam0/mask.png`: optional; 0 where pictures are never of the floor.
/// - `state_groundtruth_estimate0`: optional, absent at frames that it does not cover; the yaw of
///   its quaternion is the heading.
class ImageFolder : public FrameSource {
 public:
  static constexpr std::int64_t kMaxInterpolationGapNs = 2'000'000'000;

  /// `path`: the folder with `mav0` in it, or `mav0` itself. Pictures must be there, but are
  /// decoded only when asked for, except for the first, whose size is checked. Throws InputError
  /// with file and line.
  explicit ImageFolder(const std::filesystem::path& path, const OdometryGaps& gaps = {});

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return infos_.size(); }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  /// Colour is turned to grey; a rotation tag of the file is ignored, as the camera's calibration
  /// is that of the sensor.
  cv::Mat image(std::size_t i) const override;
  /// Of the file's bytes, which are read once.
  std::uint64_t picture_id(std::size_t i) const override;
  /// That of `cam0/mask.png`, where there is one.
  cv::Mat given_mask() const override { return mask_; }
  std::string picture_name(std::size_t i) const override {
    return pictures_[i].filename().string();
  }
  bool has_odometry() const override { return has_odometry_; }
  /// At the sensor's own rate, beyond the frames as well.
  RecordedOdometry recorded_odometry() const override { return odometry_; }
  SetUpFiles set_up_files() const override { return {true, altimeter_scale_}; }
  /// What was made of sensors' readings that cannot be, of pictures without any, doubts about the
  /// camera, and folders and keys of a `sensor.yaml` that nobody reads, a line each.
  const std::vector<std::string>& remarks() const { return remarks_; }
  /// The pictures and the files of all sensors, each a regular file.
  std::vector<std::filesystem::path> files() const;
  /// The file of frame i's picture.
  const std::filesystem::path& picture(std::size_t i) const { return pictures_[i]; }
  /// Compass and positioning system, as recorded.
  const FolderSensors& sensors() const { return sensors_; }
  /// Whether every frame has ground truth.
  bool has_ground_truth() const override { return has_ground_truth_; }

 private:
  void read_frames();
  void refuse_other_units(const SensorCsv& csv) const;
  void leave_out_uncovered(const TimeLine& times, const std::filesystem::path& csv);
  void remark(std::optional<std::string> text);
  void read_altitudes();
  void read_attitude();
  void read_odometry(const OdometryGaps& gaps);
  void read_ground_truth();

  std::filesystem::path mav0_;
  Camera camera_;
  std::vector<FrameInfo> infos_;
  std::vector<std::filesystem::path> pictures_;
  cv::Mat mask_;
  FolderSensors sensors_;
  double altimeter_scale_ = 1.0;
  RecordedOdometry odometry_;
  std::vector<std::string> remarks_;
  FileIds ids_;
  bool has_odometry_ = false;
  bool has_ground_truth_ = false;
};

/// Writes a survey as an image folder: PNG pictures named by their time stamps, numbers with 17
/// digits, `odometry0` with the covariances xy, xt, yt after the variances. ImageFolder reads back
/// the same frames and bit-identical pictures; over a hole `odometry0` has no rows. Headings and
/// fixes go to `compass0` and `position0`. Fixes that jump on purpose
/// are to be kept (`outliers: keep`).
/// `folder/mav0` is written whole or not at all; an older
/// one is replaced. Throws InputError.
void write_image_folder(const FrameSource& source, const std::filesystem::path& folder,
                        const AbsoluteReadings& readings = {});

}  // namespace fathom
