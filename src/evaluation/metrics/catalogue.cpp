#include <algorithm>
#include <cmath>

#include "fathom/core/text.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

// Those whose names do not depend on options.
const std::vector<Metric>& named_metrics() {
  static const std::vector<Metric> metrics = [] {
    std::vector<Metric> all = accuracy_metrics();
    append(all, consistency_metrics());
    append(all, honesty_metrics());
    append(all, held_out_metrics());
    append(all, optimum_metrics());
    append(all, loop_metrics());
    append(all, absolute_metrics());
    append(all, cost_metrics());
    return all;
  }();
  return metrics;
}

std::vector<std::string> texts_of(const std::vector<double>& numbers) {
  std::vector<std::string> texts;
  texts.reserve(numbers.size());
  for (const double number : numbers) texts.push_back(number_text(number));
  return texts;
}

void put_values(std::map<std::string, double>& values, const std::vector<Metric>& metrics,
                const JudgedRun& run) {
  for (const Metric& metric : metrics) {
    const std::optional<double> value = metric.value(run);
    if (value && std::isfinite(*value)) values[metric.name] = *value;
  }
}

}  // namespace

const std::vector<Metric>& metric_catalogue() {
  static const std::vector<Metric> metrics = [] {
    std::vector<Metric> all = named_metrics();
    append(all, relative_error_metrics({"N"}, {"D"}));
    append(all, relative_consistency_metrics({"N"}, {"D"}));
    return all;
  }();
  return metrics;
}

std::optional<Metric> find_metric(const std::string& name) {
  const std::vector<Metric>& all = named_metrics();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&name](const Metric& metric) { return metric.name == name; });
  if (found != all.end()) return *found;
  auto relative = relative_error_metric(name);
  return relative ? relative : relative_consistency_metric(name);
}

bool is_cost_metric(const std::string& name) {
  const auto metric = find_metric(name);
  return metric && metric->is_cost;
}

std::map<std::string, double> metric_values(const JudgedRun& run) {
  std::map<std::string, double> values;
  put_values(values, named_metrics(), run);
  const MetricOptions& options = run.facts.options;
  const std::vector<std::string> keyframes = texts_of(options.rpe_keyframes);
  const std::vector<std::string> distances_m = texts_of(options.rpe_distances_m);
  put_values(values, relative_error_metrics(keyframes, distances_m), run);
  put_values(values, relative_consistency_metrics(keyframes, distances_m), run);
  return values;
}

}  // namespace fathom
