#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"

namespace fathom {

/// A heading of the body in the world, counter-clockwise from the world's x axis.
struct MeasuredHeading {
  std::int64_t time_ns = 0;
  double heading_rad = 0.0;
  double sigma_rad = 0.0;  ///< > 0
};

/// Where the antenna of a positioning system was, world frame.
struct PositionFix {
  std::int64_t time_ns = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< m², positive definite
};

/// What compass and positioning system measured of a survey, each in order of time.
struct AbsoluteReadings {
  std::vector<MeasuredHeading> headings;
  std::vector<PositionFix> fixes;
  Eigen::Vector2d lever_m = Eigen::Vector2d::Zero();  ///< the antenna in the body frame
  bool has_jumps = false;                             ///< of fixes, on purpose: a simulation's

  bool is_empty() const { return headings.empty() && fixes.empty(); }
};

/// Which readings of a recorded sensor are used.
struct ReadingChoice {
  bool is_used = true;
  double interval_s = 1.0;  ///< least time from one that is used to the next; 0: all are

  /// Below `group`; `sensor` is the folder's, for the help.
  void describe(OptionTable& table, const std::string& group, const std::string& sensor);
};

/// The first reading, and each that comes `interval_s` or more after the one before; times of whole
/// nanoseconds count as if they were exact.
template <class Reading>
std::vector<Reading> chosen(const std::vector<Reading>& readings, const ReadingChoice& choice) {
  std::vector<Reading> taken;
  if (!choice.is_used) return taken;
  const double least_ns = 1e9 * choice.interval_s - 1.0;
  for (const Reading& reading : readings) {
    const bool is_due =
        taken.empty() || static_cast<double>(reading.time_ns - taken.back().time_ns) >= least_ns;
    if (is_due) taken.push_back(reading);
  }
  return taken;
}

}  // namespace fathom
