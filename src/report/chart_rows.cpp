#include "chart_rows.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "contenders.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/measurements/decision.hpp"

namespace fathom {
namespace {

constexpr double kBoundsProbability = 0.95;

Interval interval_or_point(const MetricSummary& summary) {
  return summary.interval.value_or(Interval{summary.moments.mean, summary.moments.mean});
}

// Less is better.
double badness(double mean, Better better) {
  return six_digits(better == Better::higher ? -mean : mean);
}

}  // namespace

double six_digits(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return std::strtod(buffer, nullptr);
}

BandedMean banded(double mean, const std::optional<double>& standard_deviation) {
  const double spread = 2.0 * standard_deviation.value_or(0.0);
  return {mean, mean < 0.0 ? mean - spread : std::max(0.0, mean - spread), mean + spread};
}

std::optional<std::vector<double>> numeric_positions(const std::vector<std::string>& labels) {
  std::vector<double> positions;
  for (const std::string& label : labels) {
    const auto number = parse_real(label);
    if (!number) return std::nullopt;
    positions.push_back(*number);
  }
  return positions;
}

std::vector<CostPoint> cost_points(const CellResults& cell, const std::string& accuracy,
                                   const std::string& cost) {
  std::vector<CostPoint> points;
  const Contenders by_accuracy = contenders_of(cell, accuracy);
  const Contenders by_cost = contenders_of(cell, cost);
  for (const EstimatorResults& one : cell.estimators) {
    const auto error = one.metrics.find(accuracy);
    const auto costs = one.metrics.find(cost);
    if (error == one.metrics.end() || costs == one.metrics.end()) continue;
    const bool is_compared = by_accuracy.find(one.name) && by_cost.find(one.name);
    const MetricSummary errors =
        is_compared ? summary_over(one, accuracy, by_accuracy.trials) : error->second;
    const MetricSummary spent =
        is_compared ? summary_over(one, cost, by_cost.trials) : costs->second;
    const double mean = spent.moments.mean;
    if (!(mean > 0.0)) continue;
    Interval interval = interval_or_point(spent);
    if (!(interval.low > 0.0)) interval.low = mean;
    points.push_back(
        {one.name, mean, errors.moments.mean, interval, interval_or_point(errors), is_compared});
  }
  return points;
}

std::vector<CostPoint> pareto_front(const std::vector<CostPoint>& points, Better better) {
  if (better == Better::neither) return {};
  const auto beats = [better](const CostPoint& a, const CostPoint& b) {
    const double of_a = badness(a.error, better);
    const double of_b = badness(b.error, better);
    const double cost_a = six_digits(a.cost);
    const double cost_b = six_digits(b.cost);
    return a.is_compared && cost_a <= cost_b && of_a <= of_b && (cost_a < cost_b || of_a < of_b);
  };
  std::vector<CostPoint> front;
  for (const CostPoint& point : points) {
    const auto beats_it = [&](const auto& other) { return beats(other, point); };
    if (point.is_compared && std::ranges::none_of(points, beats_it)) front.push_back(point);
  }
  std::ranges::stable_sort(front, {}, &CostPoint::cost);
  return front;
}

std::map<std::string, std::size_t> ranks_of(const CellResults& cell, const std::string& metric) {
  std::map<std::string, std::size_t> ranks;
  const Contenders compared = contenders_of(cell, metric);
  std::size_t rank = 0;
  for (std::size_t i = 0; i < compared.order.size(); ++i) {
    const double mean = six_digits(compared.order[i].mean);
    if (i > 0 && mean != six_digits(compared.order[i - 1].mean)) rank = i;
    ranks[compared.order[i].one->name] = rank;
  }
  return ranks;
}

NeesChart nees_chart(const CellResults& cell, const std::vector<EstimatorSeries>& series) {
  NeesChart chart;
  for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
    const KeyframeStatistics& all = series[i].keyframes;
    NeesChart::Points points;
    for (std::size_t k = 0; k < all.keyframe.size(); ++k) {
      const double x = static_cast<double>(all.keyframe[k]);
      if (all.anees[k] && *all.anees[k] > 0.0) points.emplace_back(x, *all.anees[k]);
    }
    if (points.empty()) continue;
    chart.lines.emplace_back(cell.estimators[i].name, std::move(points));
    const std::size_t draws = *std::max_element(all.nees_draws.begin(), all.nees_draws.end());
    if (draws <= chart.draws) continue;
    chart.draws = draws;
    chart.keyframes = all.keyframe.size();
    chart.low.clear();
    chart.high.clear();
    for (std::size_t k = 0; k < all.keyframe.size(); ++k) {
      if (all.nees_draws[k] == 0) continue;
      const Interval interval = anees_interval(all.nees_draws[k], 3, kBoundsProbability);
      chart.low.emplace_back(static_cast<double>(all.keyframe[k]), interval.low);
      chart.high.emplace_back(static_cast<double>(all.keyframe[k]), interval.high);
    }
  }
  return chart;
}

std::vector<std::pair<std::string, std::size_t>> outcome_counts(const EstimatorResults& estimator,
                                                                const StudyDescription& study) {
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const Outcome outcome : kOutcomes) {
    const auto found = estimator.outcomes.find(name_of(outcome));
    if (found != estimator.outcomes.end()) counts.emplace_back(*found);
  }
  for (const auto& entry : estimator.outcomes) {
    const auto is_it = [&entry](Outcome outcome) { return name_of(outcome) == entry.first; };
    if (std::ranges::none_of(kOutcomes, is_it)) counts.emplace_back(entry);
  }
  const std::size_t wanted = study.surveys * study.trials;
  if (estimator.runs.size() < wanted) {
    counts.emplace_back("not run", wanted - estimator.runs.size());
  }
  return counts;
}

}  // namespace fathom
