#include "attitude_readings.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"

namespace fathom {
namespace {

std::string degrees(double angle_rad) {
  return short_number(angle_rad * 180.0 / std::numbers::pi, 3);
}

std::string span_text(const std::vector<AttitudeReading>& readings, double Tilt::*angle) {
  double low = readings.front().tilt.*angle;
  double high = low;
  double sum = 0.0;
  for (const AttitudeReading& reading : readings) {
    low = std::min(low, reading.tilt.*angle);
    high = std::max(high, reading.tilt.*angle);
    sum += reading.tilt.*angle;
  }
  return fmt::format("{} to {} degrees, mean {}", degrees(low), degrees(high),
                     degrees(sum / static_cast<double>(readings.size())));
}

}  // namespace

AttitudeReading attitude_of(std::int64_t time_ns, const ImuMessage& imu) {
  const Eigen::Matrix3d R = imu.rotation.normalized().toRotationMatrix();
  const Tilt tilt{std::atan2(R(2, 1), R(2, 2)), std::asin(std::clamp(-R(2, 0), -1.0, 1.0))};
  return {time_ns, tilt, imu.tilt_variance};
}

AttitudeRows attitude_rows(const std::vector<AttitudeReading>& readings, double sigma_rad,
                           bool all) {
  AttitudeRows result;
  const std::string what = fmt::format("roll {}, pitch {}", span_text(readings, &Tilt::roll_rad),
                                       span_text(readings, &Tilt::pitch_rad));
  result.fact = what;
  for (const AttitudeReading& reading : readings) {
    const Tilt& tilt = reading.tilt;
    const double stated_rad = std::sqrt(reading.variance);
    if (!(std::max(std::abs(tilt.roll_rad), std::abs(tilt.pitch_rad)) <= kMostTiltRad)) {
      result.why_not = what + "; its axes are not the body's, x forward, y to port, z up";
      result.rows.clear();
      return result;
    }
    const bool is_stated = !all && stated_rad > 0.0;
    result.unstated += is_stated || all ? 0 : 1;
    result.rows += sensor_row(reading.time_ns,
                              {tilt.roll_rad, tilt.pitch_rad, is_stated ? stated_rad : sigma_rad});
  }
  return result;
}

}  // namespace fathom
