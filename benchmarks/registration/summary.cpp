#include "summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fathom/core/chi_squared.hpp"

namespace fathom::benchmarks {
namespace {

struct Judged {
  std::size_t bucket;
  bool is_time_split;
  Verdict verdict;
};

std::optional<NisSummary> summarise_nis(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  constexpr double kDegrees = 3.0;
  const auto n = static_cast<double>(values.size());
  NisSummary nis;
  nis.count = values.size();
  nis.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  nis.expected = {chi_squared_quantile(0.025, kDegrees * n) / n,
                  chi_squared_quantile(0.975, kDegrees * n) / n};
  const double limit = chi_squared_quantile(0.95, kDegrees);
  nis.share_beyond_95 =
      static_cast<double>(std::ranges::count_if(values, [&](double v) { return v > limit; })) / n;
  return nis;
}

MedianAnd95 median_and_95(const std::vector<double>& values) {
  return {percentile(values, 0.5), percentile(values, 0.95)};
}

ContenderSummary summarise(const std::vector<Judged>& pairs, std::size_t buckets) {
  ContenderSummary summary;
  summary.recall_by_bucket.resize(buckets);
  std::vector<double> metres, pixels, radians, nis, match_ms, solve_ms;
  for (const auto& [bucket, is_time_split, verdict] : pairs) {
    for (Share* share : {&summary.recall, &summary.recall_by_bucket[bucket]}) {
      ++share->count;
      share->successes += verdict.right ? 1 : 0;
    }
    if (is_time_split) {
      match_ms.push_back(verdict.match_ms);
      solve_ms.push_back(verdict.solve_ms);
    }
    if (!verdict.accepted) continue;
    ++summary.wrong.count;
    summary.wrong.successes += verdict.right ? 0 : 1;
    if (!verdict.right) continue;
    metres.push_back(verdict.translation_m);
    pixels.push_back(verdict.translation_px);
    radians.push_back(verdict.heading_rad);
    if (verdict.nis) nis.push_back(*verdict.nis);
  }
  summary.translation_m = median_and_95(metres);
  summary.translation_px = median_and_95(pixels);
  summary.heading_rad = median_and_95(radians);
  summary.nis = summarise_nis(nis);
  summary.match_ms = percentile(match_ms, 0.5);
  summary.solve_ms = percentile(solve_ms, 0.5);
  return summary;
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::ranges::sort(values);
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

CellSummary summarise(const Cell& cell, std::size_t buckets) {
  std::vector<Judged> ours;
  std::vector<Judged> opencv;
  for (const PairRecord& pair : cell.pairs) {
    ours.push_back({pair.bucket, pair.is_time_split, pair.ours});
    if (pair.opencv) opencv.push_back({pair.bucket, true, *pair.opencv});
  }
  CellSummary summary{cell.floor, cell.condition, percentile(cell.extraction_ms, 0.5),
                      summarise(ours, buckets), std::nullopt};
  if (!opencv.empty()) summary.opencv = summarise(opencv, buckets);
  return summary;
}

}  // namespace fathom::benchmarks
