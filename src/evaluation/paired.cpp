#include "fathom/evaluation/paired.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <string>

#include "checks.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

std::optional<PairedDifference> difference_over(const std::vector<double>& differences,
                                                const BootstrapOptions& options) {
  PairedDifference result;
  result.count = result.trials = differences.size();
  result.interval = bootstrap_interval(differences, options);
  if (differences.empty()) return std::nullopt;
  result.mean = std::accumulate(differences.begin(), differences.end(), 0.0) /
                static_cast<double>(differences.size());
  result.signed_rank = wilcoxon_signed_rank(differences);
  return result;
}

}  // namespace

bool PairedDifference::is_on_one_side() const {
  const auto tested = static_cast<double>(signed_rank.count);
  const double half = 0.25 * tested * (tested + 1.0);
  return (signed_rank.positive_rank_sum > half) == (mean > 0.0);
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
    throw InputError(
        fmt::format("a paired difference needs two lists of the same trials, got {} and {}",
                    a.size(), b.size()));
  }
  require_finite(a, "a paired difference");
  require_finite(b, "a paired difference");
  std::vector<double> differences;
  differences.reserve(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  return difference_over(differences, options);
}

std::optional<PairedDifference> difference_over_surveys(const ClusteredValues& differences,
                                                        const BootstrapOptions& options) {
  if (differences.empty()) return std::nullopt;
  std::size_t trials = 0;
  for (const auto& [survey, values] : differences) {
    require_finite(values, "a paired difference");
    trials += values.size();
  }
  if (differences.size() == 1) return difference_over(differences.begin()->second, options);
  auto result = difference_over(survey_means(differences), options);
  result->trials = trials;
  result->is_over_surveys = true;
  result->interval = hierarchical_interval(differences, options);
  return result;
}

std::optional<SignedRankTest> test_over_surveys(const ClusteredValues& differences) {
  if (differences.empty()) return std::nullopt;
  return wilcoxon_signed_rank(differences.size() == 1 ? differences.begin()->second
                                                      : survey_means(differences));
}

}  // namespace fathom
