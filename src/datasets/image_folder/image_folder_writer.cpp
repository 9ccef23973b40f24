#include <cmath>
#include <string>
#include <system_error>

#include "fathom/core/input_error.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_file.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

void write_pictures(const FrameSource& source, const fs::path& mav0) {
  std::string rows;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const std::string stamp = std::to_string(source.info(i).time_ns);
    rows += stamp;
    rows += ',' + stamp + ".png\n";
  }
  write_camera(mav0, rows, source.camera().model());
  std::error_code error;
  fs::create_directories(mav0 / "cam0" / "data", error);
  const cv::Mat mask = source.given_mask();
  if (!mask.empty()) write_png(mav0 / "cam0" / "mask.png", mask);
  for (std::size_t i = 0; i < source.size(); ++i) {
    write_png(mav0 / "cam0" / "data" / (std::to_string(source.info(i).time_ns) + ".png"),
              source.image(i));
  }
}

std::string altitude_rows(const FrameSource& source) {
  std::string rows;
  for (std::size_t i = 0; i < source.size(); ++i) {
    rows += sensor_row(source.info(i).time_ns, {source.info(i).altitude_m});
  }
  return rows;
}

std::string attitude_rows(const FrameSource& source) {
  std::string rows;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const MeasuredTilt& measured = source.info(i).tilt.value();
    rows += sensor_row(source.info(i).time_ns,
                       {measured.tilt.roll_rad, measured.tilt.pitch_rad, measured.sigma_rad});
  }
  return rows;
}

std::string odometry_rows(const FrameSource& source) {
  std::string rows;
  Pose pose;
  for (std::size_t i = 0; i < source.size(); ++i) {
    // Over a hole there are none but at its ends.
    const bool leads_on = i + 1 < source.size() && source.info(i + 1).is_hole;
    // No motion leads to the first frame.
    const UncertainPose motion = source.info(i).motion.value_or(UncertainPose{});
    pose = compose(pose, motion.mean);
    const Eigen::Matrix3d& C = motion.covariance;
    if (source.info(i).is_hole && leads_on) continue;
    rows += sensor_row(source.info(i).time_ns, {pose.x, pose.y, pose.theta, C(0, 0), C(1, 1),
                                                C(2, 2), C(0, 1), C(0, 2), C(1, 2)});
  }
  return rows;
}

std::string reference_rows(const FrameSource& source) {
  std::string rows;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (!source.info(i).ground_truth) continue;
    const Pose& pose = *source.info(i).ground_truth;
    rows += sensor_row(source.info(i).time_ns, {pose.x, pose.y, 0.0, std::cos(pose.theta / 2), 0.0,
                                                0.0, std::sin(pose.theta / 2)});
  }
  return rows;
}

}  // namespace

void write_image_folder(const FrameSource& source, const fs::path& folder,
                        const AbsoluteReadings& readings) {
  if (source.size() == 0) throw InputError("a survey without frames cannot be written");
  StagedFolder staged(folder);
  const fs::path mav0 = staged.path() / "mav0";
  write_pictures(source, mav0);
  write_altimeter(mav0, altitude_rows(source));
  if (source.has_attitude()) write_attitude(mav0, attitude_rows(source));
  if (source.has_odometry()) write_odometry(mav0, odometry_rows(source));
  write_folder_sensors(readings, mav0);
  const std::string reference = reference_rows(source);
  if (!reference.empty()) write_reference(mav0 / "state_groundtruth_estimate0", reference);
  staged.commit();
}

}  // namespace fathom
