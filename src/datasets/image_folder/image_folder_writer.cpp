#include <cmath>
#include <string>
#include <system_error>

#include "camera_yaml.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_file.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

std::string row(std::int64_t time_ns, std::initializer_list<double> values) {
  std::string text = std::to_string(time_ns);
  for (const double value : values) text += ',' + exact(value);
  return text + '\n';
}

void write_sensor(const fs::path& folder, const std::string& csv, const std::string& yaml) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
  write_file(folder / "data.csv", csv);
  write_file(folder / "sensor.yaml", yaml);
}

void write_camera(const FrameSource& source, const fs::path& mav0) {
  const fs::path folder = mav0 / "cam0";
  std::string csv = "#timestamp [ns],filename\n";
  for (std::size_t i = 0; i < source.size(); ++i) {
    const std::string stamp = std::to_string(source.info(i).time_ns);
    csv += stamp;
    csv += ',' + stamp + ".png\n";
  }
  write_sensor(folder, csv, camera_yaml(source.camera().model()));
  std::error_code error;
  fs::create_directories(folder / "data", error);
  for (std::size_t i = 0; i < source.size(); ++i) {
    write_png(folder / "data" / (std::to_string(source.info(i).time_ns) + ".png"), source.image(i));
  }
}

void write_altimeter(const FrameSource& source, const fs::path& mav0) {
  std::string csv = "#timestamp [ns],altitude [m]\n";
  for (std::size_t i = 0; i < source.size(); ++i) {
    csv += row(source.info(i).time_ns, {source.info(i).altitude_m});
  }
  write_sensor(mav0 / "altimeter0", csv, "sensor_type: altimeter\n");
}

void write_odometry(const FrameSource& source, const fs::path& mav0) {
  std::string csv =
      "#timestamp [ns],p_x [m],p_y [m],theta [rad],step_var_x [m^2],step_var_y [m^2],"
      "step_var_theta [rad^2],step_cov_xy [m^2],step_cov_xt [m rad],step_cov_yt [m rad]\n";
  Pose pose;
  for (std::size_t i = 0; i < source.size(); ++i) {
    // No motion leads to the first frame.
    const UncertainPose motion = source.info(i).motion.value_or(UncertainPose{});
    pose = compose(pose, motion.mean);
    const Eigen::Matrix3d& C = motion.covariance;
    csv += row(source.info(i).time_ns,
               {pose.x, pose.y, pose.theta, C(0, 0), C(1, 1), C(2, 2), C(0, 1), C(0, 2), C(1, 2)});
  }
  write_sensor(mav0 / "odometry0", csv,
               "sensor_type: odometry # integrated pose in its own frame; the step's covariance is "
               "of the motion since the row before, in the frame of that row\n");
}

void write_ground_truth(const FrameSource& source, const fs::path& mav0) {
  std::string csv = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  bool any = false;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (!source.info(i).ground_truth) continue;
    const Pose& pose = *source.info(i).ground_truth;
    csv += row(source.info(i).time_ns,
               {pose.x, pose.y, 0.0, std::cos(pose.theta / 2), 0.0, 0.0, std::sin(pose.theta / 2)});
    any = true;
  }
  if (any) {
    write_sensor(mav0 / "state_groundtruth_estimate0", csv, "sensor_type: ground truth\n");
  }
}

}  // namespace

void write_image_folder(const FrameSource& source, const fs::path& folder) {
  if (source.size() == 0) throw InputError("a survey without frames cannot be written");
  StagedFolder staged(folder);
  const fs::path mav0 = staged.path() / "mav0";
  write_camera(source, mav0);
  write_altimeter(source, mav0);
  if (source.has_odometry()) write_odometry(source, mav0);
  write_ground_truth(source, mav0);
  staged.commit();
}

}  // namespace fathom
