#include "measure.hpp"

#include <memory>
#include <vector>

#include "fathom/core/workers.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/memory_meter/memory_meter.hpp"

namespace fathom::benchmarks {
namespace {

double thread_cpu_ms() {
  return 1e3 * thread_processor_seconds();
}

// Ends a replay between two keyframes; a batch solve is not interrupted.
struct OverBudget {};

Run replay_once(const MeasurementLog& log, const Contender& contender, SolveMode mode,
                const Effort& effort, double until_ms) {
  const auto meter = make_memory_meter();
  ReplayOptions options;
  options.mode = mode;
  options.covariances = effort.covariances;
  options.memory = meter.get();
  options.progress = [until_ms](std::size_t, std::size_t) {
    if (thread_cpu_ms() > until_ms) throw OverBudget();
  };
  return replay(log, *contender.entry, contender.values, options);
}

}  // namespace

Cost measure(const MeasurementLog& log, const Contender& contender, SolveMode mode,
             const Effort& effort) {
  Cost cost;
  cost.estimator = contender.label;
  cost.mode = mode;
  const double until_ms = thread_cpu_ms() + 1e3 * effort.budget_s;
  std::optional<Run> fastest;
  try {
    for (int i = 0; i < effort.repeats && thread_cpu_ms() < until_ms; ++i) {
      Run run = replay_once(log, contender, mode, effort, until_ms);
      if (!fastest || run.costs.cpu_ms < fastest->costs.cpu_ms) fastest = std::move(run);
    }
  } catch (const OverBudget&) {
  }
  cost.gave_up = !fastest || fastest->costs.cpu_ms > 1e3 * effort.budget_s;
  cost.total_ms = fastest ? fastest->costs.cpu_ms : 1e3 * effort.budget_s;
  if (cost.gave_up) return cost;
  cost.outcome = fastest->outcome;
  cost.linearisations = fastest->iterations;
  cost.chi2 = chi2(log, fastest->trajectory);
  if (mode == SolveMode::incremental) cost.update_ms = summarise(fastest->costs.update_ms);
  cost.covariance_ms = fastest->costs.covariance_ms;
  if (fastest->costs.memory_bytes) {
    cost.memory_mib = static_cast<double>(*fastest->costs.memory_bytes) / (1 << 20);
  }
  return cost;
}

}  // namespace fathom::benchmarks
