#include "fathom/datasets/series_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fathom/core/median.hpp"

namespace fathom {
namespace {

/// Which pairs of readings agree.
class Agreement {
 public:
  Agreement(const ReadingSeries& series, double sigmas) : series_(series) {
    std::vector<double> intervals_ns;
    std::vector<double> changes;
    for (std::size_t i = 1; i < series.times_ns.size(); ++i) {
      intervals_ns.push_back(duration_ns(i - 1, i));
      changes.push_back(series.apart(i - 1, i));
    }
    usual_interval_ns_ = upper_median(std::move(intervals_ns));
    // The median of a half-normal is 0.6745 σ, and a change has the variance of two readings.
    constexpr double kSigmaOfMedian = 1.4826;
    within_ = sigmas * kSigmaOfMedian / std::numbers::sqrt2 * upper_median(std::move(changes));
  }

  /// How far two readings disagree, as a share of what two that agree may.
  double share(std::size_t i, std::size_t j) const {
    const double apart = series_.apart(i, j);
    const double intervals = std::max(1.0, duration_ns(i, j) / usual_interval_ns_);
    return apart > 0.0 ? apart / std::max(series_.allowed(i, j), within_ * intervals) : 0.0;
  }

 private:
  double duration_ns(std::size_t i, std::size_t j) const {
    return static_cast<double>(series_.times_ns[j] - series_.times_ns[i]);
  }

  const ReadingSeries& series_;
  double usual_interval_ns_ = 1.0;
  double within_ = 0.0;
};

// Decides between ways that leave out equally many.
constexpr double kShareCost = 1e-3;

/// The cheapest way to a reading that is kept, over kept ones before it.
struct CheapestWay {
  double cost = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> before;
};

std::vector<CheapestWay> cheapest_ways(std::size_t count, const Agreement& agreement,
                                       const OutlierLimits& limits) {
  std::vector<CheapestWay> ways(count);
  for (std::size_t j = 0; j < count; ++j) {
    CheapestWay& way = ways[j];
    if (j <= limits.most_in_a_row) way.cost = limits.end_cost * static_cast<double>(j);
    // The nearest first, so that of ways that cost the same the one with most readings is taken.
    for (std::size_t left_out = 0; left_out <= limits.most_in_a_row && left_out < j; ++left_out) {
      const std::size_t i = j - 1 - left_out;
      double cost = ways[i].cost + static_cast<double>(left_out);
      if (cost >= way.cost) continue;
      const double share = agreement.share(i, j);
      cost += share <= 1.0 ? kShareCost * share : limits.jump_cost;
      if (cost < way.cost) way = {cost, i};
    }
  }
  return ways;
}

}  // namespace

std::vector<bool> kept_readings(const ReadingSeries& series, const OutlierLimits& limits) {
  const std::size_t count = series.times_ns.size();
  if (count < std::max<std::size_t>(limits.least_readings, 2))
    return std::vector<bool>(count, true);
  const std::vector<CheapestWay> ways =
      cheapest_ways(count, Agreement(series, limits.sigmas), limits);
  std::optional<std::size_t> last = count - 1;
  double least = ways.back().cost;
  for (std::size_t beyond = 1; beyond <= limits.most_in_a_row && beyond < count; ++beyond) {
    const std::size_t j = count - 1 - beyond;
    const double cost = ways[j].cost + limits.end_cost * static_cast<double>(beyond);
    if (cost >= least) continue;
    least = cost;
    last = j;
  }
  std::vector<bool> kept(count, false);
  for (; last; last = ways[*last].before) kept[*last] = true;
  return kept;
}

std::vector<bool> kept_values(std::span<const std::int64_t> times_ns,
                              std::span<const double> values, double allowed,
                              const OutlierLimits& limits) {
  return kept_readings(
      {times_ns, [values](std::size_t i, std::size_t j) { return std::abs(values[j] - values[i]); },
       [allowed](std::size_t, std::size_t) { return allowed; }},
      limits);
}

std::vector<bool> plausible_altitudes(std::span<const std::int64_t> times_ns,
                                      std::span<const double> altitudes_m) {
  // Of the logarithm: 43 % more or 30 % less than a neighbour. Relief of a fifth stays, half and
  // double do not.
  constexpr double kAllowed = 0.36;
  std::vector<std::size_t> above_floor;
  std::vector<std::int64_t> their_times_ns;
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < altitudes_m.size(); ++i) {
    if (!(altitudes_m[i] > 0.0)) continue;
    above_floor.push_back(i);
    their_times_ns.push_back(times_ns[i]);
    logarithms.push_back(std::log(altitudes_m[i]));
  }
  const std::vector<bool> kept_above = kept_values(their_times_ns, logarithms, kAllowed);
  std::vector<bool> kept(altitudes_m.size(), false);
  for (std::size_t i = 0; i < above_floor.size(); ++i) kept[above_floor[i]] = kept_above[i];
  return kept;
}

}  // namespace fathom
