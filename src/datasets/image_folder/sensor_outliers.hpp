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

/// The sensor's share of a remark on readings that are not `plausible`: "altimeter0: 11 of 113
/// readings left out (first: line 14, DETAIL; …)", or that they contradict their neighbours and
/// `are_kept`.
std::string outlier_remark(const std::string& sensor, const std::vector<bool>& plausible,
                           std::size_t line_of_first, const std::string& detail, bool are_kept);

/// The index of the first reading that is not plausible; nothing where all are.
std::optional<std::size_t> first_outlier(const std::vector<bool>& plausible);

/// Which of the attitudes are plausible: those that their neighbours contradict by neither angle.
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
