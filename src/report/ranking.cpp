#include "ranking.hpp"

#include <algorithm>

namespace fathom {
namespace {

constexpr double kError = 0.05;  // of all intervals together
constexpr std::size_t kResamples = 2000;

bool is_ranked(const EstimatorResults& one, const std::string& metric,
               const std::vector<std::string>& names) {
  return one.name != kDeadReckoning && one.failures() == 0 && one.metrics.contains(metric) &&
         (names.empty() || std::ranges::find(names, one.name) != names.end());
}

// A single trial tests nothing.
void adjust(std::vector<RankedEstimator>& estimators) {
  const auto p_of = [](const RankedEstimator& one) {
    return one.difference && one.difference->count > 1 ? one.difference->signed_rank.p_value
                                                       : std::nullopt;
  };
  std::vector<double> p_values;
  for (const RankedEstimator& one : estimators) {
    if (p_of(one)) p_values.push_back(*p_of(one));
  }
  const std::vector<double> adjusted = holm(p_values);
  auto next = adjusted.begin();
  for (RankedEstimator& one : estimators) {
    if (p_of(one)) one.holm_p = *next++;
  }
}

}  // namespace

const RankedEstimator* Ranking::find(const std::string& estimator) const {
  const auto found = std::ranges::find(estimators, estimator, &RankedEstimator::name);
  return found == estimators.end() ? nullptr : &*found;
}

std::vector<const RankedEstimator*> Ranking::told_apart() const {
  std::vector<const RankedEstimator*> list;
  for (const RankedEstimator& one : estimators) {
    if (one.is_told_apart()) list.push_back(&one);
  }
  return list;
}

std::optional<Ranking> ranking(const CellResults& cell, const std::string& metric,
                               const std::vector<std::string>& names) {
  const Better better = described(metric).better;
  if (better == Better::neither) return std::nullopt;
  std::vector<const EstimatorResults*> order;
  for (const EstimatorResults& one : cell.estimators) {
    if (is_ranked(one, metric, names)) order.push_back(&one);
  }
  if (order.empty()) return std::nullopt;
  const auto mean = [&](const EstimatorResults* one) {
    return one->metrics.at(metric).moments.mean;
  };
  std::ranges::stable_sort(order, [&](const auto* a, const auto* b) {
    return better == Better::lower ? mean(a) < mean(b) : mean(a) > mean(b);
  });
  Ranking result;
  result.metric = metric;
  const std::size_t differences = std::max<std::size_t>(1, order.size() - 1);
  result.level = 1.0 - kError / static_cast<double>(differences);
  // The ends of a wider interval are in the tail, where more resamples are needed.
  const BootstrapOptions options{.probability = result.level,
                                 .resamples = kResamples * std::min<std::size_t>(3, differences)};
  for (const EstimatorResults* one : order) {
    RankedEstimator entry{one->name, one->metrics.at(metric), std::nullopt, std::nullopt};
    if (one != order.front()) {
      entry.difference = difference_between(*one, *order.front(), metric, options);
    }
    result.estimators.push_back(std::move(entry));
  }
  adjust(result.estimators);
  return result;
}

std::optional<std::string> ranking_metric(const StudyResults& results) {
  for (const std::string& name : results.study.metrics) {
    const Metric metric = described(name);
    if (metric.is_cost || metric.better == Better::neither) continue;
    for (const CellResults& cell : results.cells) {
      const auto has = [&](const auto& one) { return is_ranked(one, name, {}); };
      if (std::ranges::any_of(cell.estimators, has)) return name;
    }
  }
  return std::nullopt;
}

}  // namespace fathom
