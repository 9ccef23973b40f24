#include "fathom/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "checks.hpp"
#include "distributions.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "fathom/evaluation/summary.hpp"

namespace fathom {
namespace {

double mean_of(std::span<const double> values) {
  const double n = static_cast<double>(values.size());
  return std::accumulate(values.begin(), values.end(), 0.0) / n;
}

std::vector<double> deviations_from(double centre, std::span<const double> values) {
  std::vector<double> deviations;
  deviations.reserve(values.size());
  for (const double value : values) deviations.push_back(value - centre);
  return deviations;
}

double largest_magnitude(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

void require_probability(double probability) {
  if (probability > 0.0 && probability < 1.0) return;
  throw InputError("a bootstrap interval needs a probability between 0 and 1, got " +
                   std::to_string(probability));
}

// Means of resamples of the deviations; with replacement.
std::vector<double> resampled_means(const std::vector<double>& deviations,
                                    const BootstrapOptions& options) {
  RandomStream random(options.seed, "bootstrap");
  const std::uint64_t n = deviations.size();
  std::vector<double> means(options.resamples);
  for (double& mean : means) {
    // Two indices by one draw: drawing is what a bootstrap spends its time on.
    double sum = n % 2 == 0 ? 0.0 : deviations[random.index(n)];
    for (std::uint64_t drawn = n % 2; drawn < n; drawn += 2) {
      const std::uint64_t pair = random.index(n * n);
      sum += deviations[pair / n] + deviations[pair % n];
    }
    mean = sum / static_cast<double>(n);
  }
  return means;
}

// z₀: by how much the replicates' median lies below the estimate, in standard normal units.
double bias_correction(double estimate, std::span<const double> replicates) {
  const std::vector<double> deviations = deviations_from(estimate, replicates);
  // Equal resamples in another order differ by rounding.
  const double tolerance = 1e-10 * largest_magnitude(deviations);
  double below = 0.0;
  for (const double deviation : deviations) {
    if (std::abs(deviation) <= tolerance) {
      below += 0.5;
    } else if (deviation < 0.0) {
      below += 1.0;
    }
  }
  const double count = static_cast<double>(replicates.size());
  return normal_quantile(std::clamp(below, 0.5, count - 0.5) / count);
}

double acceleration(std::span<const double> jackknife) {
  const std::vector<double> deviations = deviations_from(mean_of(jackknife), jackknife);
  const double scale = largest_magnitude(deviations);
  if (scale == 0.0) return 0.0;
  double squares = 0.0;
  double cubes = 0.0;
  for (const double deviation : deviations) {
    const double influence = -deviation / scale;
    squares += influence * influence;
    cubes += influence * influence * influence;
  }
  return cubes / (6.0 * std::pow(squares, 1.5));
}

// The share of replicates below the end that would be at z, were the statistic normal.
double bca_level(double z, double bias, double acceleration) {
  const double shifted = bias + z;
  const double divisor = 1.0 - acceleration * shifted;
  // The limit of the formula at divisor 0, and past it.
  if (divisor <= 0.0) return shifted > 0.0 ? 1.0 : 0.0;
  return normal_cdf(bias + shifted / divisor);
}

}  // namespace

std::optional<Moments> moments(std::span<const double> values) {
  const auto summary = summarise(values);
  if (!summary) return std::nullopt;
  Moments result;
  result.count = summary->count;
  result.mean = summary->mean;
  result.median = summary->median;
  result.max = summary->max;
  const bool has_nan = std::isnan(summary->max);
  result.min = has_nan ? summary->max : *std::min_element(values.begin(), values.end());
  if (values.size() < 2) return result;
  double squares = 0.0;
  for (const double d : deviations_from(result.mean, values)) squares += d * d;
  result.standard_deviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return result;
}

Interval bca_interval(double estimate, std::span<const double> replicates,
                      std::span<const double> jackknife, double probability) {
  require_probability(probability);
  require_finite(std::span(&estimate, 1), "a bootstrap interval");
  require_finite(replicates, "a bootstrap interval");
  require_finite(jackknife, "a bootstrap interval");
  if (replicates.empty() || jackknife.empty()) {
    throw InputError("a bootstrap interval needs at least 1 resample and 1 jackknife value");
  }
  const double bias = bias_correction(estimate, replicates);
  const double a = acceleration(jackknife);
  const double z = normal_quantile(0.5 * (1.0 - probability));
  return {quantile(replicates, bca_level(z, bias, a)),
          quantile(replicates, bca_level(-z, bias, a))};
}

std::optional<Interval> bootstrap_interval(std::span<const double> values,
                                           const BootstrapOptions& options) {
  require_probability(options.probability);
  if (options.resamples == 0) throw InputError("a bootstrap interval needs at least 1 resample");
  require_finite(values, "a bootstrap interval");
  if (values.size() < 2) return std::nullopt;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  if (*min == *max) return Interval{*min, *max};
  const double mean = mean_of(values);
  std::vector<double> deviations = deviations_from(mean, values);
  // The mean was rounded to its own size, which may be far more than the spread.
  deviations = deviations_from(mean_of(deviations), deviations);
  // Of deviations that sum to 0, all but the i-th have the mean −dᵢ / (n − 1).
  std::vector<double> jackknife;
  jackknife.reserve(values.size());
  for (const double d : deviations) {
    jackknife.push_back(-d / static_cast<double>(values.size() - 1));
  }
  const Interval about_mean =
      bca_interval(0.0, resampled_means(deviations, options), jackknife, options.probability);
  const double widened = few_values(values.size(), options.probability);
  return Interval{mean + widened * about_mean.low, mean + widened * about_mean.high};
}

}  // namespace fathom
