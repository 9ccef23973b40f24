#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fathom {

/// Readings of a sensor, as far as it matters which of them contradict one another.
struct ReadingSeries {
  std::span<const std::int64_t> times_ns;  ///< rising
  /// How far reading i and the later reading j disagree, at least 0.
  std::function<double(std::size_t i, std::size_t j)> apart;
  /// Two that disagree by no more than this agree, whatever the noise.
  std::function<double(std::size_t i, std::size_t j)> allowed;
};

/// What it takes for a reading to be left out. The defaults leave out runs of up to four spikes,
/// and no level that lasts for five readings; of Gaussian noise none in a million, of Student's t
/// with three degrees of freedom 3 in 1000 (series_outliers_test.cpp).
struct OutlierLimits {
  /// Neighbours agree within so many standard deviations of a reading, by the median change between
  /// neighbours; of readings further apart in time, within as many more.
  double sigmas = 8.0;
  /// A jump that stays costs as much as so many readings left out, so that a run of fewer than
  /// twice as many is left out where it jumps there and back.
  double jump_cost = 2.25;
  /// Of a reading at either end, which nothing beyond it contradicts; within, it is 1.
  double end_cost = 2.0;
  std::size_t most_in_a_row = 8;   ///< readings left out
  std::size_t least_readings = 5;  ///< of fewer none is left out
};

/// Of each reading whether it is kept: the fewest are left out that leave the fewest jumps between
/// neighbours (jump_cost), and among those the ones that disagree most, found by dynamic
/// programming. A ramp that is no steeper than `allowed`,
/// a step that stays and noise of any size stay.
std::vector<bool> kept_readings(const ReadingSeries& series, const OutlierLimits& limits = {});

/// The same of numbers that agree within `allowed`.
std::vector<bool> kept_values(std::span<const std::int64_t> times_ns,
                              std::span<const double> values, double allowed,
                              const OutlierLimits& limits = {});

/// Which of the altitudes are plausible: those above zero that their neighbours do not contradict.
std::vector<bool> plausible_altitudes(std::span<const std::int64_t> times_ns,
                                      std::span<const double> altitudes_m);

}  // namespace fathom
