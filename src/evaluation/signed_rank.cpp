#include "fathom/evaluation/signed_rank.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "distributions.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

constexpr std::size_t kMaxExactCount = 50;

// Twice the mean ranks by rising magnitude, so that half ranks are whole numbers.
struct DoubledRanks {
  std::vector<std::uint64_t> ranks;
  std::uint64_t positive = 0;   ///< 2 W⁺
  double tie_correction = 0.0;  ///< Σ t³ − t over groups of t equal magnitudes

  std::uint64_t total() const {
    return std::accumulate(ranks.begin(), ranks.end(), std::uint64_t{0});
  }
};

DoubledRanks doubled_ranks(std::vector<double> differences) {
  std::sort(differences.begin(), differences.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  DoubledRanks result;
  for (std::size_t first = 0; first < differences.size();) {
    std::size_t end = first + 1;
    while (end < differences.size() && std::abs(differences[end]) == std::abs(differences[first])) {
      ++end;
    }
    const std::uint64_t doubled_rank = first + 1 + end;
    const double tied = static_cast<double>(end - first);
    result.tie_correction += tied * tied * tied - tied;
    for (; first < end; ++first) {
      result.ranks.push_back(doubled_rank);
      if (differences[first] > 0.0) result.positive += doubled_rank;
    }
  }
  return result;
}

// Twice P(W⁺ ≤ statistic). ways[s] counts the choices of signs with 2 W⁺ = s, one rank after the
// other; up to n = 50 all counts are exact in a double.
double exact_p_value(const std::vector<std::uint64_t>& ranks, std::uint64_t doubled_statistic) {
  std::vector<double> ways(doubled_statistic + 1, 0.0);
  ways[0] = 1.0;
  for (const std::uint64_t rank : ranks) {
    for (std::uint64_t sum = doubled_statistic; sum >= rank; --sum) ways[sum] += ways[sum - rank];
  }
  const double at_most = std::accumulate(ways.begin(), ways.end(), 0.0);
  return std::min(1.0, 2.0 * std::ldexp(at_most, -static_cast<int>(ranks.size())));
}

double approximate_p_value(std::size_t count, double statistic, double tie_correction) {
  const double n = static_cast<double>(count);
  const double mean = n * (n + 1.0) / 4.0;
  const double variance = (n * (n + 1.0) * (2.0 * n + 1.0) - 0.5 * tie_correction) / 24.0;
  // The statistic never lies above the mean; at the mean the correction would reach past it.
  const double distance = std::max(0.0, mean - statistic - 0.5);
  return 2.0 * normal_cdf(-distance / std::sqrt(variance));
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
  const DoubledRanks doubled = doubled_ranks(std::move(nonzero));
  const std::uint64_t doubled_statistic =
      std::min(doubled.positive, doubled.total() - doubled.positive);
  test.positive_rank_sum = 0.5 * static_cast<double>(doubled.positive);
  test.statistic = 0.5 * static_cast<double>(doubled_statistic);
  test.exact = test.count <= kMaxExactCount;
  test.p_value = test.exact
                     ? exact_p_value(doubled.ranks, doubled_statistic)
                     : approximate_p_value(test.count, test.statistic, doubled.tie_correction);
  return test;
}

}  // namespace fathom
