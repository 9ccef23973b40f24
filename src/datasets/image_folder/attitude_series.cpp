#include "attitude_series.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <string>

#include "fathom/core/text.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "sensor_csv.hpp"
#include "sensor_outliers.hpp"

namespace fathom {
namespace {

double angle(const SensorCsv& csv, const SensorRow& row, std::size_t column, const char* name) {
  const double value_rad = csv.real(row, column);
  if (std::abs(value_rad) <= kMostTiltRad) return value_rad;
  csv.refuse(row, fmt::format("{} {} is beyond {} rad (57 degrees); are these degrees? expected "
                              "radians, zero of a level body whose z is up",
                              name, row.fields[column], short_number(kMostTiltRad)));
}

double sigma(const SensorCsv& csv, const SensorRow& row) {
  const double sigma_rad = csv.real(row, 3);
  if (sigma_rad >= 0.0 && sigma_rad <= kMostTiltSigmaRad) return sigma_rad;
  csv.refuse(row, "sigma " + row.fields[3] +
                      " is no standard deviation of roll and pitch; expected radians from 0 to " +
                      short_number(kMostTiltSigmaRad));
}

}  // namespace

AttitudeSeries::AttitudeSeries(const std::filesystem::path& path, const SensorYaml& yaml) {
  const SensorCsv csv(path, "timestamp, roll, pitch, sigma", "", yaml.time_offset_ns);
  for (const SensorRow& row : csv.rows()) {
    const Tilt tilt{angle(csv, row, 1, "roll"), angle(csv, row, 2, "pitch")};
    times_.add(row.time_ns);
    tilts_.push_back({tilt, sigma(csv, row)});
    lines_.push_back(row.line);
  }
  plausible_ = KeptReadings(plausible_tilts(times_, tilts_));
  used_ = yaml.keeps_outliers ? KeptReadings(std::vector<bool>(tilts_.size(), true)) : plausible_;
}

std::optional<MeasuredTilt> AttitudeSeries::at(std::int64_t time_ns,
                                               std::int64_t max_gap_ns) const {
  return at(time_ns, max_gap_ns, used_);
}

std::optional<MeasuredTilt> AttitudeSeries::at(std::int64_t time_ns, std::int64_t max_gap_ns,
                                               const KeptReadings& of) const {
  const auto in_all = times_.around(time_ns, max_gap_ns);
  if (!in_all) return std::nullopt;
  const auto [bracket, growth] = filling(times_, of, *in_all, time_ns);
  const MeasuredTilt& before = tilts_[bracket.before];
  const MeasuredTilt& after = tilts_[bracket.after];
  const double share = bracket.share;
  MeasuredTilt found{{std::lerp(before.tilt.roll_rad, after.tilt.roll_rad, share),
                      std::lerp(before.tilt.pitch_rad, after.tilt.pitch_rad, share)},
                     std::lerp(before.sigma_rad, after.sigma_rad, share)};
  if (growth == 0.0) return found;
  const double spread_rad =
      std::max(spread_around(bracket, of, [this](auto i) { return tilts_[i].tilt.roll_rad; }),
               spread_around(bracket, of, [this](auto i) { return tilts_[i].tilt.pitch_rad; }));
  found.sigma_rad = std::min(growth * std::max(found.sigma_rad, spread_rad), kMostTiltSigmaRad);
  return found;
}

std::optional<std::string> AttitudeSeries::remark() const {
  const auto first = first_outlier(plausible_.all());
  if (!first) return std::nullopt;
  const Tilt& outlier = tilts_[*first].tilt;
  const Tilt expected = at(times_.at(*first), 0, plausible_).value().tilt;
  return outlier_remark(
      "attitude0", plausible_.all(), lines_[*first],
      fmt::format("roll and pitch {}, {} rad where its neighbours have {}, {} rad",
                  short_number(outlier.roll_rad), short_number(outlier.pitch_rad),
                  short_number(expected.roll_rad), short_number(expected.pitch_rad)),
      used_[*first]);
}

}  // namespace fathom
