#include "support/bags/survey_bag.hpp"

#include <cmath>

#include "fathom/geometry/covariance.hpp"

namespace fathom::test {
namespace {

BodyPose body_pose(const Pose& pose) {
  BodyPose body;
  body.position = {pose.x, pose.y, -3.0};
  body.rotation = {0.0, 0.0, std::sin(pose.theta / 2), std::cos(pose.theta / 2)};
  return body;
}

// Half angles, by quaternion: yaw, then pitch, then roll.
std::array<double, 4> rotation_of(double yaw, const Tilt& tilt) {
  const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
  const double cp = std::cos(tilt.pitch_rad / 2), sp = std::sin(tilt.pitch_rad / 2);
  const double cr = std::cos(tilt.roll_rad / 2), sr = std::sin(tilt.roll_rad / 2);
  return {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

CameraInformation information(const CameraModel& model) {
  CameraInformation info;
  info.width = static_cast<std::uint32_t>(model.width);
  info.height = static_cast<std::uint32_t>(model.height);
  info.D.assign(model.distortion.begin(), model.distortion.end());
  info.K = {model.fx, 0.0, model.cx, 0.0, model.fy, model.cy, 0.0, 0.0, 1.0};
  return info;
}

// Rows are as far apart as they like; here three bytes more than they need.
RawImage raw(const cv::Mat& picture) {
  RawImage image;
  image.height = static_cast<std::uint32_t>(picture.rows);
  image.width = static_cast<std::uint32_t>(picture.cols);
  image.step = image.width + 3;
  for (int row = 0; row < picture.rows; ++row) {
    image.data.insert(image.data.end(), picture.ptr(row), picture.ptr(row) + picture.cols);
    image.data.insert(image.data.end(), 3, 99);
  }
  return image;
}

}  // namespace

void write_survey_bag(const FrameSource& survey, BagWriter& writer, const SurveyBag& how) {
  UncertainPose odometry;
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const FrameInfo& info = survey.info(i);
    const std::int64_t time_ns = how.begin_ns + info.time_ns;
    const Stamps stamps{time_ns + how.record_delay_ns, time_ns / how.stamp_unit};
    writer.image("/camera/image_raw", stamps, raw(survey.image(i)));
    writer.camera_info("/camera/camera_info", stamps, information(survey.camera().model()));
    Stamps altitude = stamps;
    altitude.header_ns += how.altitude_clock_ns;
    writer.point("/altitude", altitude, {1.0, 2.0, info.altitude_m});
    if (survey.has_odometry()) {
      odometry = compose(odometry, info.motion.value_or(UncertainPose{}));
      BodyPose body = body_pose(odometry.mean);
      constexpr std::array<int, 3> kPlanar{0, 1, 5};
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
          body.covariance[6 * kPlanar[r] + kPlanar[c]] = odometry.covariance(r, c);
        }
      }
      writer.odometry("/odom", stamps, body);
    }
    if (info.ground_truth) {
      writer.pose("/ground_truth/pose", stamps, body_pose(*info.ground_truth));
      if (i >= how.imu_from) {
        const MeasuredTilt measured = info.tilt.value_or(MeasuredTilt{{}, std::sqrt(1e-3)});
        const double variance = how.imu_has_variance ? std::pow(measured.sigma_rad, 2) : 0.0;
        Tilt tilt = measured.tilt;
        tilt.roll_rad += how.imu_roll_rad;
        writer.imu("/imu", stamps, rotation_of(info.ground_truth->theta, tilt),
                   {variance, 0, 0, 0, variance, 0, 0, 0, 4e-4});
      }
    }
    writer.word("/chatter", stamps, "hello");
  }
}

}  // namespace fathom::test
