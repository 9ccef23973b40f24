#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/vision/camera.hpp"
#include "kept_readings.hpp"
#include "sensor_series.hpp"

namespace fathom {

/// `attitude0/data.csv`: time, roll and pitch of the body (rad), and the standard deviation of
/// either (rad, >= 0).
class AttitudeSeries {
 public:
  /// Throws InputError with file and line, also on angles beyond kMostTiltRad and
  /// kMostTiltSigmaRad.
  AttitudeSeries(const std::filesystem::path& csv, const SensorYaml& yaml);

  /// All three linear between two readings. Where readings were left out that their neighbours
  /// contradict, sigma is wider: by what readings around differ by, growing with the time without.
  std::optional<MeasuredTilt> at(std::int64_t time_ns, std::int64_t max_gap_ns) const;
  const TimeLine& times() const { return times_; }
  /// What was left out, or kept against its neighbours, if anything was.
  std::optional<std::string> remark() const;

 private:
  std::optional<MeasuredTilt> at(std::int64_t time_ns, std::int64_t max_gap_ns,
                                 const KeptReadings& of) const;

  TimeLine times_;
  std::vector<MeasuredTilt> tilts_;
  std::vector<std::size_t> lines_;
  KeptReadings plausible_;
  KeptReadings used_;
};

}  // namespace fathom
