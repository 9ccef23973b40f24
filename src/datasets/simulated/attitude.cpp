#include "attitude.hpp"

#include <cmath>
#include <utility>

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
  table.real_or_off("measured_sigma_rad", measured_sigma_rad, Range::between(0, 0.2), "rad",
                    "standard deviation of measured roll and pitch; off: they are not measured");
  table.real("roll_mounting_error_rad", roll_mounting_error_rad, Range::between(-0.2, 0.2), "rad",
             "by which every measured roll is too large");
  table.real("pitch_mounting_error_rad", pitch_mounting_error_rad, Range::between(-0.2, 0.2), "rad",
             "by which every measured pitch is too large");
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
  if (measured_sigma_rad) return;
  for (const auto& [key, value] :
       {std::pair("roll_mounting_error_rad", roll_mounting_error_rad),
        std::pair("pitch_mounting_error_rad", pitch_mounting_error_rad)}) {
    if (value == 0.0) continue;
    throw InputError(prefix + key + ": has no effect on what is not measured; set " + prefix +
                     "measured_sigma_rad too");
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

std::vector<MeasuredTilt> measure_attitude(const AttitudeOptions& options,
                                           const std::vector<Tilt>& tilts, std::uint64_t seed) {
  std::vector<MeasuredTilt> measured;
  if (!options.measured_sigma_rad) return measured;
  const double sigma_rad = *options.measured_sigma_rad;
  RandomStream sensor(seed, "attitude_sensor");
  for (const Tilt& tilt : tilts) {
    const double roll =
        tilt.roll_rad + options.roll_mounting_error_rad + sigma_rad * sensor.normal();
    const double pitch =
        tilt.pitch_rad + options.pitch_mounting_error_rad + sigma_rad * sensor.normal();
    measured.push_back({{roll, pitch}, sigma_rad});
  }
  return measured;
}

}  // namespace fathom
