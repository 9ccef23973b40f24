#include "fathom/evaluation/paired.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "checks.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

constexpr std::size_t kMaxExactCount = 50;

struct RankSums {
  double positive = 0.0;
  double negative = 0.0;
  double tie_correction = 0.0;  // Σ t³ − t over groups of t equal magnitudes
};

RankSums rank_sums(std::vector<double> differences) {
  std::sort(differences.begin(), differences.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  RankSums sums;
  for (std::size_t first = 0; first < differences.size();) {
    std::size_t end = first + 1;
    while (end < differences.size() && std::abs(differences[end]) == std::abs(differences[first])) {
      ++end;
    }
    const double mean_rank = 0.5 * static_cast<double>(first + 1 + end);
    const double tied = static_cast<double>(end - first);
    sums.tie_correction += tied * tied * tied - tied;
    for (; first < end; ++first) {
      (differences[first] > 0.0 ? sums.positive : sums.negative) += mean_rank;
    }
  }
  return sums;
}

// Twice P(W⁺ ≤ statistic), each of the 2ⁿ choices of signs being equally likely. The number of
// choices of each sum grows by one rank at a time; up to n = 50 all counts are exact in a double.
double exact_p_value(std::size_t count, double statistic) {
  const auto last = static_cast<std::size_t>(statistic);
  std::vector<double> ways(last + 1, 0.0);
  ways[0] = 1.0;
  for (std::size_t rank = 1; rank <= std::min(count, last); ++rank) {
    for (std::size_t sum = last; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  }
  const double below = std::accumulate(ways.begin(), ways.end(), 0.0);
  return std::min(1.0, 2.0 * std::ldexp(below, -static_cast<int>(count)));
}

double approximate_p_value(std::size_t count, double statistic, double tie_correction) {
  const double n = static_cast<double>(count);
  const double mean = n * (n + 1.0) / 4.0;
  const double variance = (n * (n + 1.0) * (2.0 * n + 1.0) - 0.5 * tie_correction) / 24.0;
  const double z = (statistic - mean) / std::sqrt(variance);
  return std::erfc(std::abs(z) / std::numbers::sqrt2);
}

}  // namespace

SignedRankTest wilcoxon_signed_rank(std::span<const double> differences) {
  std::vector<double> nonzero;
  for (const double difference : differences) {
    if (std::isnan(difference)) throw InputError("a signed-rank test needs numbers, got NaN");
    if (difference != 0.0) nonzero.push_back(difference);
  }
  SignedRankTest test;
  test.count = nonzero.size();
  if (nonzero.empty()) return test;
  const RankSums sums = rank_sums(std::move(nonzero));
  test.positive_rank_sum = sums.positive;
  test.statistic = std::min(sums.positive, sums.negative);
  test.exact = test.count <= kMaxExactCount && sums.tie_correction == 0.0;
  test.p_value = test.exact ? exact_p_value(test.count, test.statistic)
                            : approximate_p_value(test.count, test.statistic, sums.tie_correction);
  return test;
}

std::vector<double> holm(std::span<const double> p_values) {
  for (const double p : p_values) {
    if (!(p >= 0.0 && p <= 1.0)) {
      throw InputError("a p-value lies from 0 to 1, got " + std::to_string(p));
    }
  }
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t step = 0; step < order.size(); ++step) {
    const double hypotheses_left = static_cast<double>(order.size() - step);
    largest = std::max(largest, std::min(1.0, hypotheses_left * p_values[order[step]]));
    adjusted[order[step]] = largest;
  }
  return adjusted;
}

std::optional<PairedDifference> paired_difference(std::span<const double> a,
                                                  std::span<const double> b,
                                                  const BootstrapOptions& options) {
  if (a.size() != b.size()) {
    throw InputError("a paired difference needs two lists of the same trials, got " +
                     std::to_string(a.size()) + " and " + std::to_string(b.size()));
  }
  require_finite(a, "a paired difference");
  require_finite(b, "a paired difference");
  std::vector<double> differences;
  differences.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  PairedDifference result;
  result.count = differences.size();
  result.interval = bootstrap_interval(differences, options);
  if (differences.empty()) return std::nullopt;
  result.mean = std::accumulate(differences.begin(), differences.end(), 0.0) /
                static_cast<double>(differences.size());
  result.signed_rank = wilcoxon_signed_rank(differences);
  return result;
}

}  // namespace fathom
