#include "keyframe_series.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fathom/evaluation/summary.hpp"
#include "fathom/results/run_index.hpp"
#include "fathom/results/run_series.hpp"

namespace fathom {
namespace {

// Sums over the trials at one keyframe.
struct Sums {
  std::size_t errors = 0;
  double error = 0.0;
  double error_squared = 0.0;
  std::size_t bounds = 0;
  double bound = 0.0;
  std::size_t nees_count = 0;
  double nees = 0.0;
  std::set<std::size_t> nees_surveys;
};

template <class Entry>
std::vector<Entry> series_or_none(const ResultStore& store, const RunKey& key,
                                  const RunSeries<Entry>& series) {
  return series_of(store, key, series).value_or(std::vector<Entry>{});
}

// Whether errors and covariances are of one gauge: with keyframe 0 held neither has any there, with
// an uncertain start and unaligned errors both have. Aligned by all poses, or at the origin with an
// uncertain start, they are of two, and not to be compared.
bool are_of_one_gauge(const std::vector<double>& errors, double first_trace) {
  constexpr double kNone_m = 1e-6;  // beyond the rounding of a country's coordinates
  if (errors.empty() || !std::isfinite(errors[0])) return true;
  return (errors[0] < kNone_m) == (first_trace < kNone_m * kNone_m);
}

void add_run(const ResultStore& store, const RunKey& key, std::vector<Sums>& sums) {
  const auto errors = series_or_none(store, key, series::position_error_m);
  const auto xx = series_or_none(store, key, series::cov_xx);
  const auto yy = series_or_none(store, key, series::cov_yy);
  const auto nees = series_or_none(store, key, series::pose_nees);
  std::size_t covariances = std::min(xx.size(), yy.size());
  if (covariances > 0 && !are_of_one_gauge(errors, xx[0] + yy[0])) covariances = 0;
  // NEES is known from keyframe 1 on.
  sums.resize(
      std::max({sums.size(), errors.size(), covariances, nees.empty() ? 0 : nees.size() + 1}));
  for (std::size_t k = 0; k < errors.size(); ++k) {
    if (!std::isfinite(errors[k])) continue;
    ++sums[k].errors;
    sums[k].error += errors[k];
    sums[k].error_squared += errors[k] * errors[k];
  }
  for (std::size_t k = 0; k < covariances; ++k) {
    const double trace = xx[k] + yy[k];
    if (!std::isfinite(trace) || trace < 0.0) continue;
    ++sums[k].bounds;
    sums[k].bound += 2.0 * std::sqrt(trace);
  }
  for (std::size_t i = 0; i < nees.size(); ++i) {
    if (!std::isfinite(nees[i])) continue;
    ++sums[i + 1].nees_count;
    sums[i + 1].nees += nees[i];
    sums[i + 1].nees_surveys.insert(key.survey);
  }
}

std::optional<double> ratio(double sum, std::size_t count) {
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

std::optional<double> deviation(const Sums& sums) {
  if (sums.errors < 2) return std::nullopt;
  const auto count = static_cast<double>(sums.errors);
  const double spread = sums.error_squared - sums.error * sums.error / count;
  return std::sqrt(std::max(0.0, spread) / (count - 1.0));
}

KeyframeStatistics keyframe_statistics(const ResultStore& store, const EstimatorResults& runs,
                                       Repetition repetition) {
  std::vector<Sums> sums;
  for (const RunRecord& run : runs.runs) {
    if (!is_failed(run)) add_run(store, run.key, sums);
  }
  KeyframeStatistics result;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Sums& at = sums[k];
    result.keyframe.push_back(k);
    result.count.push_back(at.errors);
    result.mean_m.push_back(ratio(at.error, at.errors));
    result.sd_m.push_back(deviation(at));
    const auto square = ratio(at.error_squared, at.errors);
    result.empirical_m.push_back(square ? std::optional(2.0 * std::sqrt(*square)) : std::nullopt);
    result.estimated_m.push_back(ratio(at.bound, at.bounds));
    result.nees_count.push_back(at.nees_count);
    result.nees_draws.push_back(
        independent_draws(repetition, at.nees_surveys.size(), at.nees_count));
    result.anees.push_back(ratio(at.nees / 3.0, at.nees_count));
  }
  return result;
}

UpdateCost update_cost(const ResultStore& store, const EstimatorResults& runs) {
  std::map<std::size_t, std::vector<double>> costs;
  for (const RunRecord& run : runs.runs) {
    if (is_failed(run) || run.machine != runs.cost_machine) continue;
    const auto keyframes = series_or_none(store, run.key, series::update_keyframe);
    const auto times = series_or_none(store, run.key, series::update_ms);
    for (std::size_t i = 0; i < std::min(keyframes.size(), times.size()); ++i) {
      if (std::isfinite(times[i])) costs[keyframes[i]].push_back(times[i]);
    }
  }
  UpdateCost result;
  for (const auto& [keyframe, times] : costs) {
    result.keyframe.push_back(keyframe);
    result.count.push_back(times.size());
    result.median_ms.push_back(quantile(times, 0.5));
  }
  return result;
}

std::optional<SweepBounds> sweep_bounds(const KeyframeStatistics& statistics) {
  double squares = 0.0;
  std::size_t errors = 0;
  double bounds = 0.0;
  std::size_t bound_count = 0;
  for (std::size_t i = 0; i < statistics.keyframe.size(); ++i) {
    if (statistics.keyframe[i] == 0) continue;
    if (const auto twice = statistics.empirical_m[i]) {
      squares += *twice * *twice;
      ++errors;
    }
    if (const auto bound = statistics.estimated_m[i]) {
      bounds += *bound;
      ++bound_count;
    }
  }
  if (errors == 0) return std::nullopt;
  return SweepBounds{std::sqrt(squares / static_cast<double>(errors)), ratio(bounds, bound_count)};
}

}  // namespace

EstimatorSeries estimator_series(const ResultStore& store, const EstimatorResults& runs,
                                 Repetition repetition) {
  EstimatorSeries series{
      keyframe_statistics(store, runs, repetition), update_cost(store, runs), {}};
  series.bounds = sweep_bounds(series.keyframes);
  return series;
}

std::vector<std::vector<EstimatorSeries>> study_series(const ResultStore& store,
                                                       const StudyResults& results) {
  std::vector<std::vector<EstimatorSeries>> all;
  for (const CellResults& cell : results.cells) {
    all.emplace_back();
    for (const EstimatorResults& one : cell.estimators) {
      all.back().push_back(estimator_series(store, one, cell.repetition));
    }
  }
  return all;
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> picked;
  const std::size_t step =
      std::max<std::size_t>(1, (count + most - 1) / std::max<std::size_t>(1, most));
  for (std::size_t i = 0; i < count; i += step) picked.push_back(i);
  if (count > 0 && picked.back() != count - 1) picked.push_back(count - 1);
  return picked;
}

}  // namespace fathom
