#include "interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fathom/core/median.hpp"
#include "odometry_track.hpp"
#include "residuals.hpp"

namespace fathom {

double gain_of_interpolation(const RecordedOdometry& odometry, std::span<const SeenMotion> motions,
                             double offset_s) {
  std::vector<double> motions_s;
  for (const SeenMotion& motion : motions) motions_s.push_back(std::abs(seconds_of(motion)));
  std::vector<double> rows_s;
  std::vector<std::int64_t> times_ns;
  for (const ReckonedRow& row : odometry.rows) {
    if (!times_ns.empty())
      rows_s.push_back(1e-9 * static_cast<double>(row.time_ns - times_ns.back()));
    times_ns.push_back(row.time_ns);
  }
  const double rows_each = std::max(1.0, upper_median(motions_s) / upper_median(rows_s));
  const std::int64_t shift_ns = nanoseconds(offset_s);
  // f (1 − f) of a time.
  const auto averaged = [&](std::int64_t time_ns) {
    const auto after = std::ranges::lower_bound(times_ns, time_ns - shift_ns);
    if (after == times_ns.begin() || after == times_ns.end()) return 0.0;
    const std::int64_t before_ns = *std::prev(after);
    const double f = static_cast<double>(time_ns - shift_ns - before_ns) /
                     static_cast<double>(*after - before_ns);
    return f * (1.0 - f);
  };
  double gain = 0.0;
  for (const SeenMotion& motion : motions) {
    gain -= 1.5 * std::log1p(-(averaged(motion.from_ns) + averaged(motion.to_ns)) / rows_each);
  }
  return gain;
}

}  // namespace fathom
