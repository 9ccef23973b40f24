#include <cmath>
#include <numeric>

#include "checks.hpp"
#include "distributions.hpp"
#include "fathom/core/random.hpp"
#include "fathom/evaluation/clustered.hpp"

namespace fathom {
namespace {

// The values of a cell about their mean, with the spread of what they are drawn from: the sample's
// own is too small by √((n − 1) / n).
struct Stratum {
  std::vector<double> deviations;
  double variance = 0.0;  ///< of their mean
};

Stratum stratum_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double mean = clustered_mean({{0, values}});
  Stratum stratum;
  for (const double value : values) {
    stratum.deviations.push_back((value - mean) * std::sqrt(count / (count - 1.0)));
    stratum.variance += std::pow(stratum.deviations.back() / count, 2);
  }
  return stratum;
}

double resampled_deviation(const std::vector<double>& deviations, RandomStream& random) {
  double sum = 0.0;
  for (std::size_t i = 0; i < deviations.size(); ++i) {
    sum += deviations[random.index(deviations.size())];
  }
  return sum / static_cast<double>(deviations.size());
}

// By what Student's interval is wider than the normal one, with the degrees of freedom that
// Satterthwaite (1946) gives a sum of variances that are estimated each by itself.
double widening(const std::vector<Stratum>& strata, double probability) {
  double variance = 0.0;
  double of_variance = 0.0;
  for (const Stratum& one : strata) {
    variance += one.variance;
    of_variance += one.variance * one.variance / static_cast<double>(one.deviations.size() - 1);
  }
  if (!(of_variance > 0.0)) return 1.0;
  const double upper = 0.5 * (1.0 + probability);
  return student_quantile(upper, variance * variance / of_variance) / normal_quantile(upper);
}

}  // namespace

std::optional<Interval> stratified_interval(std::span<const std::vector<double>> cells,
                                            const BootstrapOptions& options) {
  const auto count = static_cast<double>(cells.size());
  double estimate = 0.0;
  std::vector<Stratum> strata;
  for (const std::vector<double>& values : cells) {
    require_finite(values, "a bootstrap interval");
    if (values.size() < 2) return std::nullopt;
    estimate += clustered_mean({{0, values}}) / count;
    strata.push_back(stratum_of(values));
  }
  std::vector<double> jackknife;
  for (const Stratum& one : strata) {
    const double others = static_cast<double>(one.deviations.size() - 1);
    for (const double deviation : one.deviations)
      jackknife.push_back(-deviation / (others * count));
  }
  RandomStream random(options.seed, "bootstrap over cells");
  std::vector<double> replicates(options.resamples, 0.0);
  for (double& replicate : replicates) {
    for (const Stratum& one : strata)
      replicate += resampled_deviation(one.deviations, random) / count;
  }
  const Interval about = bca_interval(0.0, replicates, jackknife, options.probability);
  const double widened = widening(strata, options.probability);
  return Interval{estimate + widened * about.low, estimate + widened * about.high};
}

}  // namespace fathom
