#include <cmath>

#include <Eigen/LU>

#include "fathom/core/input_error.hpp"
#include "fathom/datasets/simulated_sensors.hpp"

namespace fathom {

void SimulatedCompassOptions::describe(OptionTable& table) {
  table.real_or_off("interval_s", interval_s, Range::positive(), "s",
                    "between headings; off: no compass");
  table.real("sigma_rad", sigma_rad, Range::positive(), "rad", "noise of a heading");
  table.real("bias_rad", bias_rad, Range::any(), "rad", "not in its sigma: error of all headings");
  table.real("deviation_rad", deviation_rad, Range::at_least(0), "rad",
             "not in its sigma: amplitude of an error that is a sine of the heading");
}

void SimulatedFixOptions::describe(OptionTable& table) {
  table.real_or_off("interval_s", interval_s, Range::positive(), "s", "between fixes; off: none");
  table.real("sigma_m", sigma_m, Range::at_least(0), "m", "noise of a fix, of x and of y");
  table.reals("covariance", covariance, 3, "m^2",
              "noise of a fix [xx, xy, yy], world axes; []: from sigma_m");
  table.real("lever_x_m", lever_x_m, Range::any(), "m",
             "of the antenna in the body frame, forward");
  table.real("lever_y_m", lever_y_m, Range::any(), "m", "of the antenna, to port");
  table.real("jump_share", jump_share, Range::between(0, 1), "",
             "not in the covariance: share of fixes that are off by jump_m");
  table.real("jump_m", jump_m, Range::at_least(0), "m", "of jump_share, in any direction");
  table.real("latency_s", latency_s, Range::at_least(0), "s",
             "not in the data: a fix says where the antenna was so long before");
}

Eigen::Matrix2d SimulatedFixOptions::noise_covariance(const std::string& prefix) const {
  Eigen::Matrix2d C = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  if (!covariance.empty()) {
    if (covariance.size() != 3) {
      throw InputError(prefix + "covariance: expected three numbers [xx, xy, yy], or []");
    }
    C << covariance[0], covariance[1], covariance[1], covariance[2];
  }
  const bool is_positive = C(0, 0) > 0.0 && C(1, 1) > 0.0 && C.determinant() > 0.0;
  if (is_positive && std::isfinite(C.determinant())) return C;
  if (covariance.empty()) {
    throw InputError(prefix + "sigma_m: makes the covariance singular; expected a number > 0");
  }
  throw InputError(prefix +
                   "covariance: is not positive definite; expected xx, yy > 0 and a correlation "
                   "between -1 and 1");
}

void SimulatedHoleOptions::describe(OptionTable& table) {
  table.integer("count", count, Range::between(0, 1000), "holes",
                "in dead reckoning, at times that are drawn");
  table.real("length_s", length_s, Range::positive(), "s", "of each; two frames at least");
}

void SimulatedSensorOptions::describe(OptionTable& table) {
  table.group("compass", compass);
  table.group("fixes", fixes);
  table.group("holes", holes);
  gaps.describe(table);
}

std::vector<IgnoredKey> SimulatedSensorOptions::ignored_keys() const {
  std::vector<IgnoredKey> ignored;
  const auto ignore = [&](const std::string& group, std::initializer_list<const char*> keys,
                          const std::string& chooser) {
    for (const char* key : keys) ignored.push_back({group + key, chooser});
  };
  if (!compass.interval_s) {
    ignore("compass.", {"sigma_rad", "bias_rad", "deviation_rad"}, "compass.interval_s");
  }
  if (!fixes.interval_s) {
    ignore("fixes.",
           {"sigma_m", "covariance", "lever_x_m", "lever_y_m", "jump_share", "jump_m", "latency_s"},
           "fixes.interval_s");
  } else {
    if (fixes.jump_share == 0.0) ignore("fixes.", {"jump_m"}, "fixes.jump_share");
  }
  if (holes.count == 0) {
    ignore("", {"holes.length_s", "gap_sigma_m", "gap_sigma_rad", "speed_limit_m_s"},
           "holes.count");
  } else if (gaps.sigma_m) {
    ignore("", {"speed_limit_m_s"}, "gap_sigma_m");
  }
  return ignored;
}

}  // namespace fathom
