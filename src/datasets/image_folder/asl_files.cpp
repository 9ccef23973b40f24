#include "fathom/datasets/asl_files.hpp"

#include <system_error>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

namespace fs = std::filesystem;

std::string sensor_row(std::int64_t time_ns, std::initializer_list<double> values) {
  std::string text = std::to_string(time_ns);
  for (const double value : values) text += ',' + exact(value);
  return text + '\n';
}

void write_sensor(const fs::path& folder, const std::string& columns, const std::string& rows,
                  const std::string& yaml) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
  write_file(folder / "data.csv", "#" + columns + "\n" + rows);
  write_file(folder / "sensor.yaml", yaml);
}

void write_camera(const fs::path& mav0, const std::string& rows, const CameraModel& model) {
  write_sensor(mav0 / "cam0", "timestamp [ns],filename", rows, camera_yaml(model));
}

void write_altimeter(const fs::path& mav0, const std::string& rows) {
  write_sensor(mav0 / "altimeter0", "timestamp [ns],altitude [m]", rows,
               "sensor_type: altimeter\n");
}

void write_attitude(const fs::path& mav0, const std::string& rows) {
  write_sensor(mav0 / "attitude0", "timestamp [ns],roll [rad],pitch [rad],sigma [rad]", rows,
               "sensor_type: attitude # of the body, right-handed about x forward and y to port, "
               "pitch applied after roll; sigma of either\n");
}

void write_compass(const fs::path& mav0, const std::string& rows) {
  write_sensor(mav0 / "compass0", "timestamp [ns],heading [rad],sigma [rad]", rows,
               "sensor_type: compass\nconvention: counter_clockwise_from_x # of the world, seen "
               "from above\n");
}

void write_odometry(const fs::path& mav0, const std::string& rows) {
  write_sensor(mav0 / "odometry0",
               "timestamp [ns],p_x [m],p_y [m],theta [rad],step_var_x [m^2],step_var_y [m^2],"
               "step_var_theta [rad^2],step_cov_xy [m^2],step_cov_xt [m rad],step_cov_yt [m rad]",
               rows,
               "sensor_type: odometry # integrated pose in its own frame; the step's covariance is "
               "of the motion since the row before, in the frame of that row\n");
}

void write_reference(const fs::path& folder, const std::string& rows) {
  write_sensor(folder, "timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []", rows,
               "sensor_type: ground truth\n");
}

}  // namespace fathom
