#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fathom/measurements/decision.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// A series of a run: its name in a store, and what its entries are (docs/outputs.md).
template <class Entry>
struct RunSeries {
  const char* name;
};

/// All that there are; nobody else names one.
namespace series {
using Optional = std::optional<double>;

// Of keyframes: the aligned estimate and its covariance in the aligned axes.
inline constexpr RunSeries<double> time_s{"time_s"};
inline constexpr RunSeries<double> x_m{"x_m"};
inline constexpr RunSeries<double> y_m{"y_m"};
inline constexpr RunSeries<double> theta_rad{"theta_rad"};
inline constexpr RunSeries<double> cov_xx{"cov_xx"};
inline constexpr RunSeries<double> cov_xy{"cov_xy"};
inline constexpr RunSeries<double> cov_xt{"cov_xt"};
inline constexpr RunSeries<double> cov_yy{"cov_yy"};
inline constexpr RunSeries<double> cov_yt{"cov_yt"};
inline constexpr RunSeries<double> cov_tt{"cov_tt"};
inline constexpr RunSeries<double> position_error_m{"position_error_m"};
inline constexpr RunSeries<double> heading_error_rad{"heading_error_rad"};
// From keyframe 1 on.
inline constexpr RunSeries<double> pose_nees{"pose_nees"};
inline constexpr RunSeries<double> position_nees{"position_nees"};
// Of dead reckoning's run.
inline constexpr RunSeries<double> truth_x_m{"truth_x_m"};
inline constexpr RunSeries<double> truth_y_m{"truth_y_m"};
inline constexpr RunSeries<double> truth_theta_rad{"truth_theta_rad"};
// Of updates.
inline constexpr RunSeries<std::size_t> update_keyframe{"update_keyframe"};
inline constexpr RunSeries<double> update_ms{"update_ms"};
// Of registrations.
inline constexpr RunSeries<std::size_t> loop_from{"loop_from"};
inline constexpr RunSeries<std::size_t> loop_to{"loop_to"};
inline constexpr RunSeries<LoopFate> loop_fate{"loop_fate"};
inline constexpr RunSeries<Optional> loop_nis{"loop_nis"};
inline constexpr RunSeries<double> loop_weight{"loop_weight"};
inline constexpr RunSeries<bool> loop_is_false{"loop_is_false"};
// Of absolute measurements; what one does not measure is NaN.
inline constexpr RunSeries<std::size_t> absolute_keyframe{"absolute_keyframe"};
inline constexpr RunSeries<LoopFate> absolute_fate{"absolute_fate"};
inline constexpr RunSeries<Optional> absolute_nis{"absolute_nis"};
inline constexpr RunSeries<double> absolute_weight{"absolute_weight"};
inline constexpr RunSeries<double> absolute_x_m{"absolute_x_m"};
inline constexpr RunSeries<double> absolute_y_m{"absolute_y_m"};
inline constexpr RunSeries<double> absolute_cov_xx{"absolute_cov_xx"};
inline constexpr RunSeries<double> absolute_cov_xy{"absolute_cov_xy"};
inline constexpr RunSeries<double> absolute_cov_yy{"absolute_cov_yy"};
inline constexpr RunSeries<double> absolute_theta_rad{"absolute_theta_rad"};
inline constexpr RunSeries<double> absolute_sigma_rad{"absolute_sigma_rad"};
}  // namespace series

/// How a store has an entry: as a number. Of an optional number, which is never negative, −1 is
/// none.
double number_of(double entry);
double number_of(std::size_t entry);
double number_of(bool entry);
double number_of(LoopFate entry);
double number_of(const std::optional<double>& entry);

/// The same back; false where the number is no such entry.
bool read_number(double number, double& entry);
bool read_number(double number, std::size_t& entry);
bool read_number(double number, LoopFate& entry);
bool read_number(double number, std::optional<double>& entry);

/// Puts a series, an empty one, too.
template <class Entry>
void put(RunRecord& run, const RunSeries<Entry>& series, const std::vector<Entry>& entries) {
  std::vector<double>& numbers = run.series[series.name];
  for (const Entry& entry : entries) numbers.push_back(number_of(entry));
}

/// Appends an entry; the series is there from then on.
template <class Entry>
void append(RunRecord& run, const RunSeries<Entry>& series, const Entry& entry) {
  put(run, series, {entry});
}

/// Throws InputError of an entry that is none of its type.
[[noreturn]] void refuse_entry(const ResultStore& store, const RunKey& key, const char* series,
                               double number);

/// The series of a run in a store; nothing where the run has none. Throws InputError.
template <class Entry>
std::optional<std::vector<Entry>> series_of(const ResultStore& store, const RunKey& key,
                                            const RunSeries<Entry>& series) {
  const auto numbers = store.series(key, series.name);
  if (!numbers) return std::nullopt;
  std::vector<Entry> entries(numbers->size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!read_number((*numbers)[i], entries[i])) {
      refuse_entry(store, key, series.name, (*numbers)[i]);
    }
  }
  return entries;
}

}  // namespace fathom
