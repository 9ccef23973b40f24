// Four keyframes round a square and a loop back to the first, given to every estimator that is
// registered; prints the last pose of each. A picture goes into a file's bytes and back.

#include <cmath>
#include <cstdio>
#include <vector>

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/report/table.hpp"
#include "fathom/vision/picture_codecs.hpp"

namespace {

// The dead reckoning turns a little too far at every corner; the loop knows better.
fathom::MeasurementLog square() {
  const Eigen::Matrix3d step_covariance = 1e-2 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d loop_covariance = 1e-6 * Eigen::Matrix3d::Identity();
  const fathom::Pose measured{1.0, 0.0, M_PI_2 + 0.05};
  fathom::MeasurementLog log;
  for (std::size_t k = 1; k <= 3; ++k) {
    log.add_keyframe(fathom::RelativePose::from_covariance(k - 1, k, measured, step_covariance));
  }
  log.add_registration(
      fathom::RelativePose::from_covariance(0, 3, {0.0, 1.0, -M_PI_2}, loop_covariance));
  return log;
}

bool pictures_are_coded() {
  const cv::Mat picture(2, 3, CV_8U, cv::Scalar(7));
  const cv::Mat decoded = fathom::decode_picture(fathom::encode_picture(".png", picture));
  return decoded.size() == picture.size() && decoded.at<unsigned char>(1, 2) == 7;
}

}  // namespace

int main() {
  const fathom::MeasurementLog log = square();
  fathom::Table table({"estimator", "x (m)", "y (m)", "heading (rad)"});
  bool right = pictures_are_coded();
  for (const fathom::EstimatorEntry& entry : fathom::builtin_estimators().entries()) {
    const fathom::Run replay = fathom::replay(log, entry, {}, {});
    const fathom::Pose last = replay.trajectory.back();
    table.add_row({entry.name, fathom::format_number(last.x, 3), fathom::format_number(last.y, 3),
                   fathom::format_number(last.theta, 3)});
    right = right && fathom::is_done(replay.outcome) && std::hypot(last.x, last.y - 1.0) < 0.05 &&
            std::abs(fathom::wrap_angle(last.theta + M_PI_2)) < 0.05;
  }
  std::printf("keyframe 3\n%s", table.text().c_str());
  return right ? 0 : 1;
}
