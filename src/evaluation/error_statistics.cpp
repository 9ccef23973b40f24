#include "fathom/evaluation/error_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace fathom {

std::optional<ErrorStatistics> error_statistics(std::span<const double> errors) {
  if (errors.empty()) return std::nullopt;
  std::vector<double> sorted(errors.begin(), errors.end());
  if (!std::all_of(sorted.begin(), sorted.end(), [](double e) { return std::isfinite(e); })) {
    return std::nullopt;
  }
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  const double count = static_cast<double>(sorted.size());
  ErrorStatistics result;
  result.sse = std::inner_product(sorted.begin(), sorted.end(), sorted.begin(), 0.0);
  result.rmse = std::sqrt(result.sse / count);
  result.mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / count;
  result.median =
      sorted.size() % 2 == 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2.0;
  double squares = 0.0;
  for (const double e : sorted) squares += (e - result.mean) * (e - result.mean);
  result.std = std::sqrt(squares / count);
  result.min = sorted.front();
  result.max = sorted.back();
  if (!std::isfinite(result.sse)) return std::nullopt;
  return result;
}

}  // namespace fathom
