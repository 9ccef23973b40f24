#include <numeric>
#include <utility>

#include "fathom/evaluation/summary.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

using Value = std::optional<double>;
using List = std::vector<double> Costs::*;

// A metric for each cost of a run.
class CostMetrics {
 public:
  // A few numbers of the times of one kind of call: update_ms.median, …
  void operator()(const std::string& name, const std::string& label, const std::string& unit,
                  const std::string& calls, List list) {
    const std::pair<const char*, double Summary::*> numbers[] = {{"median", &Summary::median},
                                                                 {"p95", &Summary::p95},
                                                                 {"max", &Summary::max},
                                                                 {"mean", &Summary::mean},
                                                                 {"total", &Summary::total}};
    for (const auto& [number, field] : numbers) {
      add(name + "." + number, label + ", " + number, unit,
          std::string(number) + " of the wall times of " + calls,
          [list, of = field](const Run& run) -> Value {
            const auto summary = summarise(run.costs.*list);
            if (!summary) return std::nullopt;
            return (*summary).*of;
          });
    }
  }

  // A number, or an optional one.
  template <class Field>
  void operator()(const std::string& name, const std::string& label, const std::string& unit,
                  const std::string& description, Field Costs::*field) {
    add(name, label, unit, description, [field](const Run& run) -> Value {
      const std::optional value = run.costs.*field;
      return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
    });
    if (name == "total_ms") add_total_with_covariance();
  }

  std::vector<Metric> take() { return std::move(all_); }

 private:
  template <class Of>
  void add(const std::string& name, const std::string& label, const std::string& unit,
           const std::string& description, Of of) {
    all_.push_back({name, label, unit, Better::lower, description,
                    [of](const JudgedRun& run) -> Value {
                      return run.facts.run != nullptr ? of(*run.facts.run) : std::nullopt;
                    },
                    true});
  }

  void add_total_with_covariance() {
    add("total_with_covariance_ms", "estimate and covariance, time", "ms",
        "total_ms and the covariance of the newest pose after every keyframe's update",
        [](const Run& run) -> Value {
          const std::vector<double>& covariances = run.costs.newest_covariance_ms;
          if (covariances.empty()) return std::nullopt;
          return std::accumulate(covariances.begin(), covariances.end(), run.costs.total_ms);
        });
  }

  std::vector<Metric> all_;
};

}  // namespace

std::vector<Metric> cost_metrics() {
  CostMetrics metrics;
  Costs::each(metrics);
  std::vector<Metric> all = metrics.take();
  all.push_back({"updates", "updates", "", Better::neither, "how many updates there were",
                 [](const JudgedRun& run) -> Value {
                   if (run.facts.run == nullptr) return std::nullopt;
                   return static_cast<double>(run.facts.run->costs.update_ms.size());
                 }});
  return all;
}

}  // namespace fathom
