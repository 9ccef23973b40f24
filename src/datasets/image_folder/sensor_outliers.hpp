#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fathom/vision/camera.hpp"
#include "kept_readings.hpp"
#include "sensor_series.hpp"

namespace fathom {

/// The sensor's share of a remark on readings that were left out: "altimeter0: 11 of 113 readings
/// left out (first: line 14, DETAIL; …)".
std::string left_out_remark(const std::string& sensor, const std::vector<bool>& kept,
                            std::size_t line_of_first, const std::string& detail);

/// The index of the first reading that is left out; nothing where none is.
std::optional<std::size_t> first_left_out(const std::vector<bool>& kept);

/// Which of the altitudes are kept: those above zero that their neighbours do not contradict.
std::vector<bool> plausible_altitudes(const TimeLine& times,
                                      const std::vector<double>& altitudes_m);

/// Likewise of attitudes: by either angle.
std::vector<bool> plausible_tilts(const TimeLine& times, const std::vector<MeasuredTilt>& tilts);

/// What stands in for a reading that is left out.
struct Filling {
  Bracket bracket;  ///< the kept readings around the time; one alone at an end
  /// √(1 + intervals between them), twice as many at an end; 0: nothing was left out there.
  double growth = 0.0;
};

/// The kept readings around a time, whose bracket in all of them is known.
Filling filling(const TimeLine& times, const KeptReadings& kept, const Bracket& in_all,
                std::int64_t time_ns);

/// The standard deviation of what the two nearest kept readings on either side say.
double spread_around(const Bracket& bracket, const KeptReadings& kept,
                     const std::function<double(std::size_t)>& value);

}  // namespace fathom
