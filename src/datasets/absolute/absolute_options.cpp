#include "fathom/core/input_error.hpp"
#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/gap_options.hpp"
#include "fathom/datasets/odometry_gaps.hpp"
#include "fathom/datasets/start_options.hpp"

namespace fathom {

void ReadingChoice::describe(OptionTable& table, const std::string& group,
                             const std::string& sensor) {
  table.boolean(group + ".use", is_used, "whether readings of " + sensor + " are measurements");
  table.real(group + ".interval_s", interval_s, Range::at_least(0), "s",
             "least time from one reading of " + sensor +
                 " that is used to the next, as neighbours share their errors; 0: all");
}

void StartOptions::describe(OptionTable& table) {
  const Range metres = Range::between(-1e7, 1e7);
  const Range radians = Range::between(-6.2832, 6.2832);
  table.real_or_off("x_m", x_m, metres, "m",
                    "of keyframe 0 in the world; off: by the first fixes, without fixes 0");
  table.real_or_off("y_m", y_m, metres, "m", "likewise");
  table.real_or_off("heading_rad", heading_rad, radians, "rad",
                    "of keyframe 0, counter-clockwise from the world's x; off: by the first "
                    "headings of a compass, without one 0");
  table.real("sigma_m", sigma_m, Range::at_least(0), "m", "of x_m and of y_m; 0: held");
  table.real("sigma_rad", sigma_rad, Range::at_least(0), "rad", "of heading_rad; 0: held");
}

void StartOptions::check(const std::string& prefix) const {
  if (x_m.has_value() != y_m.has_value()) {
    throw InputError(prefix + (x_m ? "y_m" : "x_m") + ": is missing; x_m and y_m go together");
  }
  if (sigma_m > 0.0 && !x_m) {
    throw InputError(prefix + "sigma_m: is of no position; expected x_m and y_m with it");
  }
  if (sigma_rad > 0.0 && !heading_rad) {
    throw InputError(prefix + "sigma_rad: is of no heading; expected heading_rad with it");
  }
}

void GapOptions::describe(OptionTable& table) {
  table.real_or_off("gap_sigma_m", sigma_m, Range::positive(), "m",
                    "declared over a hole in dead reckoning, of x and of y; off: "
                    "speed_limit_m_s times its duration");
  table.real("gap_sigma_rad", sigma_rad, Range::positive(), "rad",
             "likewise, of the heading; 1.8 is that of any heading");
  table.real("speed_limit_m_s", speed_limit_m_s, Range::positive(), "m/s",
             "how far a hole may lead, unless gap_sigma_m says it");
}

void OdometryGaps::describe(OptionTable& table) {
  table.real_or_off("gap_intervals", least_intervals, Range{1.0, 1e9, true}, "",
                    "odometry0 that stops for so many of its median intervals has a hole there, "
                    "and before its first row and after its last one; off: it has holes only "
                    "where it starts again, by a jump faster than speed_limit_m_s");
  declared.describe(table);
}

UncertainPose GapOptions::motion(double duration_s) const {
  const double sigma = sigma_m.value_or(speed_limit_m_s * duration_s);
  UncertainPose motion;
  motion.covariance =
      Eigen::Vector3d(sigma * sigma, sigma * sigma, sigma_rad * sigma_rad).asDiagonal();
  return motion;
}

}  // namespace fathom
