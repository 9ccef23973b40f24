#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

/// What a recording or a model is, by its first bytes or the files of its folder.
enum class ImportKind { ros1_bag, ros2_bag, colmap, kitti };

/// Throws InputError on what is none of them, and on their variants that are not read (compressed
/// bags, binary COLMAP models), naming the conversion.
ImportKind import_kind(const std::filesystem::path& source);

/// Which time stamps of a bag count: those of the message headers, once they are seen to agree with
/// the times of recording; those of the headers unseen; or the times of recording.
enum class BagClock { automatic, header, record };

/// How a bag becomes an image folder. A topic is its name, empty to guess it, or "none".
struct BagImportOptions {
  std::string images;
  std::string camera_info;
  std::string altitude;
  std::string odometry;
  std::string reference;
  std::string heading;
  std::string attitude;  ///< empty: the heading's

  std::filesystem::path camera_yaml;  ///< a sensor.yaml in place of the bag's CameraInfo
  std::optional<double> mount_x_m;    ///< of the camera in the body frame; absent: as camera_yaml
  std::optional<double> mount_y_m;
  std::optional<double> mount_yaw_rad;

  std::optional<double> altitude_m;  ///< of all pictures, in place of a topic
  std::string altitude_axis = "z";   ///< of a PointStamped: x, y or z

  /// Random walk of the odometry in one second, in place of the covariances in the bag.
  std::optional<double> odometry_sigma_m;
  std::optional<double> odometry_sigma_rad;
  /// The same where the bag has no covariance that could be one.
  double default_odometry_sigma_m = 0.05;
  double default_odometry_sigma_rad = 0.01;

  /// Odometry starts again where it is back at its first pose at so many times its usual speed.
  double restart_speed_factor = 5.0;
  /// Heading of the motion there, which is unknown: of the uniform distribution over the circle.
  double restart_sigma_rad = 1.8;

  /// Of a heading whose covariance the bag does not say.
  double default_heading_sigma_rad = 0.05;

  /// Of roll and pitch, in place of the covariances in the bag; and where the bag does not say.
  std::optional<double> attitude_sigma_rad;
  double default_attitude_sigma_rad = 0.01;

  BagClock clock = BagClock::automatic;
  /// By how much the header stamps of two topics may differ against their times of recording.
  double max_clock_offset_s = 1.0;
  /// Messages of a topic that come after newer ones are put in order where they are late by no more
  /// than this, and not more of them in a row: more is a clock that was set back.
  double max_late_s = 1.0;
  std::size_t max_late_in_a_row = 2;
};

/// What an import did, for the terminal; one line each, no final full stop.
struct ImportReport {
  std::vector<std::string> facts;
  std::vector<std::string> notes;  ///< assumed, guessed or left out
};

/// One line a topic: its name, type, number of messages and what it is taken for.
std::vector<std::string> bag_topic_list(const std::filesystem::path& bag,
                                        const BagImportOptions& options);

/// Writes `folder`/mav0 from a bag. Pictures are written one by one as they are read, the rest of
/// the messages is held as numbers. Throws InputError; the folder may be half-written then.
/// `progress`: messages read, of how many.
ImportReport import_bag(const std::filesystem::path& bag, const BagImportOptions& options,
                        const std::filesystem::path& folder,
                        const std::function<void(std::size_t, std::size_t)>& progress = {});

/// How poses of another tool become a reference.
struct PoseImportOptions {
  /// The survey whose pictures they are: its time stamps are taken, by the names of the pictures
  /// (COLMAP) or by their order (KITTI). Without it KITTI needs `times`; COLMAP's poses are
  /// numbered.
  std::filesystem::path survey;
  std::filesystem::path times;  ///< of KITTI: seconds, one a line
  double scale = 1.0;           ///< metres per unit of the poses
};

/// Writes `folder`/state_groundtruth_estimate0 and `folder`/reference.tum from a COLMAP text model
/// or a file of KITTI poses. Throws InputError.
ImportReport import_colmap(const std::filesystem::path& model, const PoseImportOptions& options,
                           const std::filesystem::path& folder);
ImportReport import_kitti(const std::filesystem::path& poses, const PoseImportOptions& options,
                          const std::filesystem::path& folder);

}  // namespace fathom
