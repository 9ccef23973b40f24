#pragma once

#include <cstddef>
#include <cstdint>

#include "fathom/datasets/frame_source.hpp"
#include "support/bags/bag_writer.hpp"

namespace fathom::test {

/// How a survey is written as a bag. Topics: /camera/image_raw, /camera/camera_info, /altitude,
/// /odom, /ground_truth/pose, /imu, /chatter.
struct SurveyBag {
  /// Of a survey's time 0: a bag of ROS 1 has no message at that.
  std::int64_t begin_ns = 1'700'000'000'123'456'789;
  std::int64_t record_delay_ns = 20'000'000;  ///< from header to recording
  std::int64_t altitude_clock_ns = 0;         ///< how far the altimeter's clock is ahead
  std::int64_t stamp_unit = 1;                ///< header stamps are divided by it
  std::size_t imu_from = 0;  ///< the first frame that /imu has, with the survey's roll and pitch
  bool imu_has_variance = true;  ///< of them; of a survey without, level, it is 1e-3 rad²
  double imu_roll_rad = 0.0;     ///< how the Imu is mounted
};

void write_survey_bag(const FrameSource& survey, BagWriter& writer, const SurveyBag& how = {});

}  // namespace fathom::test
