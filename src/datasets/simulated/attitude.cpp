#include "fathom/datasets/attitude.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "fathom/core/random.hpp"

namespace fathom {
namespace {

// x(k + 1) = φ x(k) + √(1 − φ²) σ w: of standard deviation σ at every step, the first included.
std::vector<double> gauss_markov(double sigma, double phi, std::size_t count, RandomStream stream) {
  std::vector<double> values;
  double value = sigma * stream.normal();
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(value);
    value = phi * value + std::sqrt(1.0 - phi * phi) * sigma * stream.normal();
  }
  return values;
}

}  // namespace

Eigen::Matrix3d Tilt::rotation() const {
  return (Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

void AttitudeOptions::describe(OptionTable& table) {
  // Three standard deviations must leave the horizon out of a wide picture.
  table.real("roll_sigma_rad", roll_sigma_rad, Range::between(0, 0.2), "rad",
             "standard deviation of the roll; the true pose stays planar");
  table.real("pitch_sigma_rad", pitch_sigma_rad, Range::between(0, 0.2), "rad",
             "standard deviation of the pitch");
  table.real_or_off("both_sigma_rad", both_sigma_rad, Range::between(0, 0.2), "rad",
                    "standard deviation of the roll and of the pitch, in place of their own");
  table.real("correlation_time_s", correlation_time_s, Range::at_least(0), "s",
             "of roll and pitch: after it a correlation of 1/e is left; 0: none");
}

void AttitudeOptions::check(const std::string& prefix) const {
  if (is_level() && correlation_time_s != AttitudeOptions().correlation_time_s) {
    throw InputError(prefix + "correlation_time_s: has no effect on a level camera; set " + prefix +
                     "roll_sigma_rad or pitch_sigma_rad too");
  }
  if (both_sigma_rad && (roll_sigma_rad != 0.0 || pitch_sigma_rad != 0.0)) {
    throw InputError(prefix +
                     "both_sigma_rad: takes the place of roll_sigma_rad and "
                     "pitch_sigma_rad; expected it or those, not both");
  }
}

std::vector<Tilt> draw_attitude(const AttitudeOptions& options, std::size_t frames, double period_s,
                                std::uint64_t seed) {
  std::vector<Tilt> tilts(frames);
  if (options.is_level()) return tilts;
  const double phi =
      options.correlation_time_s > 0.0 ? std::exp(-period_s / options.correlation_time_s) : 0.0;
  const auto roll = gauss_markov(options.roll_sigma(), phi, frames, RandomStream(seed, "roll"));
  const auto pitch = gauss_markov(options.pitch_sigma(), phi, frames, RandomStream(seed, "pitch"));
  for (std::size_t i = 0; i < frames; ++i) tilts[i] = {roll[i], pitch[i]};
  return tilts;
}

}  // namespace fathom
