#include "survey_writer.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "bag_camera.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "odometry_steps.hpp"
#include "survey_coverage.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

constexpr const char* kNoOrientation =
    " says that it has no orientation, or leaves it at its default in all messages";

class SurveyWriter {
 public:
  SurveyWriter(const BagSurvey& survey, const std::vector<BagTopic>& topics,
               const TopicChoice& choice, const BagImportOptions& options, fs::path mav0)
      : survey_(survey),
        topics_(topics),
        choice_(choice),
        options_(options),
        mav0_(std::move(mav0)) {}

  ImportReport write() {
    write_pictures();
    write_altitudes();
    if (choice_.odometry) write_odometry0();
    if (choice_.reference) write_reference0();
    if (choice_.heading) write_headings();
    if (choice_.attitude) write_attitudes();
    if (survey_.repeated > 0) {
      note(counted(survey_.repeated, "message") + " left out: at the time of the one before");
    }
    for (const std::string& line : survey_.late_notes()) note(line);
    return report_;
  }

 private:
  void fact(const std::string& line) { report_.facts.push_back(line); }
  void note(const std::string& line) { report_.notes.push_back(line); }
  const BagTopic& topic(const std::optional<std::size_t>& index) const { return topics_[*index]; }

  std::string size_text(int width, int height) const {
    return fmt::format("{} x {} pixels", width, height);
  }

  CameraModel camera_of_file() const {
    const CameraModel model = read_camera_yaml(options_.camera_yaml).model();
    if (model.width == survey_.width && model.height == survey_.height) return model;
    throw InputError(options_.camera_yaml.string(),
                     "is of " + size_text(model.width, model.height) + ", the pictures have " +
                         size_text(survey_.width, survey_.height));
  }

  CameraModel camera_of_bag() {
    const std::string& images = topic(choice_.images).name;
    const std::string& info = topic(choice_.camera_info).name;
    if (is_rectified(images)) note("rectified pictures: P of " + info + ", no distortion");
    try {
      const auto& message = survey_.camera_info.info();
      if (!message) throw InputError("has no message that could be read");
      return Camera(camera_of(*message, images, survey_.width, survey_.height)).model();
    } catch (const InputError& error) {
      std::string why = error.what();
      if (why.find("--camera") == std::string::npos)
        why += "; --camera FILE takes a sensor.yaml in its place";
      throw InputError(fmt::format("topic {}: {}", info, why));
    }
  }

  void write_pictures() {
    std::string rows;
    for (const WrittenPicture& picture : survey_.pictures) {
      rows += std::to_string(picture.time_ns) + ',' + picture.file + '\n';
    }
    if (survey_.camera_info.empty() > 0) {
      note(counted(survey_.camera_info.empty(), "CameraInfo") +
           " left out: without a calibration or a size");
    }
    CameraModel model = options_.camera_yaml.empty() ? camera_of_bag() : camera_of_file();
    const auto by_tf =
        mounting_by_tf(survey_.frames, survey_.camera_frame, survey_.body_frame, report_.notes);
    if (by_tf) {
      model.mount_x_m = by_tf->x;
      model.mount_y_m = by_tf->y;
      model.mount_yaw_rad = by_tf->theta;
    }
    model.mount_x_m = options_.mount_x_m.value_or(model.mount_x_m);
    model.mount_y_m = options_.mount_y_m.value_or(model.mount_y_m);
    model.mount_yaw_rad = options_.mount_yaw_rad.value_or(model.mount_yaw_rad);
    write_camera(mav0_, rows, Camera(model).model());
    fact(fmt::format("{} of {} from {}", counted(survey_.pictures.size(), "picture"),
                     size_text(survey_.width, survey_.height), topic(choice_.images).name));
    if (options_.camera_yaml.empty() && !options_.mount_yaw_rad && !by_tf) {
      note(
          "the camera is taken to be at the body's origin, the top of its picture forward: "
          "--mount-x, --mount-y and --mount-yaw say where it is");
    }
  }

  void write_altitudes() {
    std::string rows;
    if (options_.altitude_m) {
      for (const WrittenPicture& picture : survey_.pictures) {
        rows += sensor_row(picture.time_ns, {*options_.altitude_m});
      }
      fact("altitude: " + short_number(*options_.altitude_m, 6) + " m at all pictures");
    } else {
      for (const auto& [time_ns, altitude_m] : survey_.altitudes) {
        rows += sensor_row(time_ns, {altitude_m});
      }
      const BagTopic& from = topic(choice_.altitude);
      fact(counted(survey_.altitudes.size(), "altitude") + " from " + from.name +
           (from.type == "geometry_msgs/PointStamped" ? ", its " + options_.altitude_axis : ""));
    }
    write_altimeter(mav0_, rows);
    if (survey_.bad_altitudes > 0) {
      note(counted(survey_.bad_altitudes, "altitude") +
           " left out: not above zero, or outside of what the sensor measures");
    }
  }

  void write_odometry0() {
    const OdometryRows odometry = odometry_rows(survey_.odometry, options_);
    std::string rows;
    for (const OdometryRow& row : odometry.rows) {
      const Eigen::Matrix3d& C = row.step_covariance;
      rows += sensor_row(row.time_ns, {row.pose.x, row.pose.y, row.pose.theta, C(0, 0), C(1, 1),
                                       C(2, 2), C(0, 1), C(0, 2), C(1, 2)});
    }
    write_odometry(mav0_, rows);
    fact(fmt::format("{} of odometry from {}", counted(odometry.rows.size(), "pose"),
                     topic(choice_.odometry).name));
    note("covariance of a step of odometry: " + odometry.covariance_from);
    for (const std::size_t i : odometry.restarts) {
      const Pose jump = between(odometry.rows[i - 1].pose, odometry.rows[i].pose);
      note(fmt::format(
          "{} starts again at {} s: it jumps {} m back to its first pose. The motion there is "
          "unknown: its sigma is the length of the jump; or cut the bag there",
          topic(choice_.odometry).name, seconds_text(odometry.rows[i].time_ns),
          short_number(jump.position().norm())));
    }
  }

  void write_reference0() {
    std::string rows;
    for (const OdometryReading& reading : survey_.reference) {
      const Eigen::Vector3d& p = reading.message.position;
      const Eigen::Quaterniond& q = reading.message.rotation;
      rows += sensor_row(reading.time_ns, {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()});
    }
    if (rows.empty()) return;
    write_reference(mav0_ / "state_groundtruth_estimate0", rows);
    fact(fmt::format("{} of reference (ground truth) from {}",
                     counted(survey_.reference.size(), "pose"), topic(choice_.reference).name));
    const std::int64_t first_ns = survey_.reference.front().time_ns;
    const std::int64_t last_ns = survey_.reference.back().time_ns;
    const auto is_covered = [&](const WrittenPicture& picture) {
      return picture.time_ns >= first_ns && picture.time_ns <= last_ns;
    };
    if (std::ranges::none_of(survey_.pictures, is_covered)) {
      note("the reference shares no time with the pictures: no error can be computed by it");
    }
  }

  void note_unknown(std::size_t count, const char* what, const std::string& most_variance,
                    const std::string& name) {
    if (count == 0) return;
    note(counted(count, what) + " left out: by a variance that is not within 0 to " +
         most_variance + " " + name + " says that it does not know");
  }

  void write_headings() {
    const double sigma_rad = options_.default_heading_sigma_rad;
    std::string rows;
    std::size_t unstated = 0;
    for (const HeadingReading& heading : survey_.headings) {
      const double stated_rad = std::sqrt(heading.variance);
      unstated += stated_rad > 0.0 ? 0 : 1;
      rows +=
          sensor_row(heading.time_ns, {heading.yaw_rad, stated_rad > 0.0 ? stated_rad : sigma_rad});
    }
    const std::string& name = topic(choice_.heading).name;
    note_unknown(survey_.unknown_headings, "heading", "pi^2", name);
    if (rows.empty() && survey_.unknown_headings == 0) note("no heading: " + name + kNoOrientation);
    if (rows.empty()) return;
    write_compass(mav0_, rows);
    fact(fmt::format("{} from {}, in compass0", counted(survey_.headings.size(), "heading"), name));
    note(
        "a run takes them for headings in the world: right of a compass or an AHRS; of a yaw "
        "that drifts dataset.compass.use: false leaves them out");
    if (unstated > 0) {
      note(fmt::format("{} without variance in the bag: taken for good to {} rad",
                       counted(unstated, "heading"), short_number(sigma_rad)));
    }
  }

  void write_attitudes() {
    const std::string& name = topic(choice_.attitude).name;
    const double sigma_rad =
        options_.attitude_sigma_rad.value_or(options_.default_attitude_sigma_rad);
    const std::size_t unknown = survey_.unknown_attitudes;
    note_unknown(unknown, "attitude", short_number(kMostTiltSigmaRad * kMostTiltSigmaRad), name);
    if (survey_.attitudes.empty() && unknown == 0) note("no attitude: " + name + kNoOrientation);
    if (survey_.attitudes.empty()) return;
    const AttitudeRows attitude =
        attitude_rows(survey_.attitudes, sigma_rad, options_.attitude_sigma_rad.has_value());
    if (!attitude.why_not.empty()) return note("no attitude of " + name + ": " + attitude.why_not);
    const std::size_t without = uncovered(survey_.pictures, attitude_times(survey_));
    if (without > 0) {
      return note("no attitude of " + name + ": " + counted(without, "picture") +
                  " lie outside of its readings; --attitude " + name + " leaves them out");
    }
    write_attitude(mav0_, attitude.rows);
    fact(counted(survey_.attitudes.size(), "attitude") + " from " + name + ": " + attitude.fact);
    note("roll and pitch are taken to be those of the body; --attitude none takes it for level");
    if (attitude.unstated > 0) {
      note(fmt::format("{} without variance in the bag: taken for good to {} rad",
                       counted(attitude.unstated, "attitude"), short_number(sigma_rad)));
    }
  }

  const BagSurvey& survey_;
  const std::vector<BagTopic>& topics_;
  const TopicChoice& choice_;
  const BagImportOptions& options_;
  fs::path mav0_;
  ImportReport report_;
};

}  // namespace

ImportReport write_survey(const BagSurvey& survey, const std::vector<BagTopic>& topics,
                          const TopicChoice& choice, const BagImportOptions& options,
                          const fs::path& mav0) {
  return SurveyWriter(survey, topics, choice, options, mav0).write();
}

}  // namespace fathom
