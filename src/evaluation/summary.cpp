#include "fathom/evaluation/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool has_nan(std::span<const double> values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

double quantile_of_sorted(const std::vector<double>& sorted, double probability) {
  const double rank = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const double share = rank - static_cast<double>(below);
  // No product with a neighbour that has no share: it may be infinite, or not there.
  if (share == 0.0) return sorted[below];
  return sorted[below] * (1.0 - share) + sorted[below + 1] * share;
}

}  // namespace

double quantile(std::span<const double> values, double probability) {
  if (values.empty()) throw InputError("a quantile needs at least one value");
  if (!(probability >= 0.0 && probability <= 1.0)) {
    throw InputError("a quantile needs a probability from 0 to 1, got " +
                     std::to_string(probability));
  }
  if (has_nan(values)) return kNaN;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  return quantile_of_sorted(sorted, probability);
}

std::optional<Summary> summarise(std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  if (has_nan(values)) return Summary{values.size(), kNaN, kNaN, kNaN, kNaN, kNaN};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  Summary summary;
  summary.count = sorted.size();
  summary.total = std::accumulate(values.begin(), values.end(), 0.0);
  summary.mean = summary.total / static_cast<double>(sorted.size());
  summary.median = quantile_of_sorted(sorted, 0.5);
  summary.p95 = quantile_of_sorted(sorted, 0.95);
  summary.max = sorted.back();
  return summary;
}

}  // namespace fathom
