#include <numeric>
#include <utility>

#include "fathom/evaluation/summary.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

using Series = std::span<const double> ReplayFacts::*;

// A few numbers of the times of one kind of call: update_ms.median, …
std::vector<Metric> times_of(Series series, const std::string& name, const std::string& label,
                             const std::string& calls) {
  const std::pair<const char*, double Summary::*> numbers[] = {{"median", &Summary::median},
                                                               {"p95", &Summary::p95},
                                                               {"max", &Summary::max},
                                                               {"mean", &Summary::mean},
                                                               {"total", &Summary::total}};
  std::vector<Metric> metrics;
  for (const auto& [number, field] : numbers) {
    metrics.push_back({name + "." + number, label + ", " + number, "ms", Better::lower,
                       std::string(number) + " of the wall times of " + calls,
                       [series, field = field](const JudgedRun& run) -> std::optional<double> {
                         if (!run.facts.replay) return std::nullopt;
                         const auto summary = summarise((*run.facts.replay).*series);
                         if (!summary) return std::nullopt;
                         return (*summary).*field;
                       }});
  }
  return metrics;
}

std::optional<double> total_with_covariance_ms(const JudgedRun& run) {
  if (!run.facts.replay || run.facts.replay->newest_covariance_ms.empty()) return std::nullopt;
  const std::span<const double> covariances = run.facts.replay->newest_covariance_ms;
  return std::accumulate(covariances.begin(), covariances.end(), run.facts.replay->total_ms);
}

}  // namespace

std::vector<Metric> cost_metrics() {
  std::vector<Metric> all;
  append(all, times_of(&ReplayFacts::update_ms, "update_ms", "update time",
                       "updates: calls with registrations, without the keyframe's own, or the "
                       "batch solve"));
  append(all,
         times_of(&ReplayFacts::add_ms, "add_ms", "add time", "the calls that add a keyframe"));
  append(all, times_of(&ReplayFacts::newest_covariance_ms, "newest_covariance_ms",
                       "time of the newest covariance",
                       "the covariance of the newest pose, asked for after every keyframe's "
                       "update"));
  append(all, {{"total_ms", "estimate, time", "ms", Better::lower,
                "wall time of all calls for the estimate: keyframes, updates, and covariances that "
                "gates or its own loop candidates ask for",
                replay_field(&ReplayFacts::total_ms)},
               {"total_with_covariance_ms", "estimate and covariance, time", "ms", Better::lower,
                "total_ms and the covariance of the newest pose after every keyframe's update",
                total_with_covariance_ms},
               {"candidate_covariance_ms", "candidates' covariance time", "ms", Better::lower,
                "wall time of the covariances that its own loop candidates ask for, a part of "
                "total_ms",
                replay_field(&ReplayFacts::candidate_covariance_ms)},
               {"cpu_ms", "CPU time", "ms", Better::lower,
                "CPU time of its threads over the same calls", replay_field(&ReplayFacts::cpu_ms)},
               {"covariance_ms", "covariance time", "ms", Better::lower,
                "wall time of the covariances of all keyframes, asked for once, at the end",
                replay_field(&ReplayFacts::covariance_ms)},
               {"start_up_ms", "start-up", "ms", Better::lower,
                "CPU time of the start-up of a program that does the work, no part of the others",
                replay_field(&ReplayFacts::start_up_ms)},
               {"memory_bytes", "memory", "bytes", Better::lower,
                "peak heap of the estimator; of a program all that it had in use",
                replay_field(&ReplayFacts::memory_bytes)}});
  for (Metric& metric : all) metric.is_cost = true;
  all.push_back({"updates", "updates", "", Better::neither, "how many updates there were",
                 [](const JudgedRun& run) -> std::optional<double> {
                   if (!run.facts.replay) return std::nullopt;
                   return static_cast<double>(run.facts.replay->update_ms.size());
                 }});
  return all;
}

}  // namespace fathom
