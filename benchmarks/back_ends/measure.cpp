#include "measure.hpp"

#include <ctime>
#include <memory>
#include <vector>

#include "apps/memory_meter.hpp"

namespace fathom::benchmarks {
namespace {

double thread_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Run {
  Cost cost;
  std::vector<double> step_ms;
};

void note(const UpdateReport& report, Cost& cost) {
  cost.outcome = worse(cost.outcome, report.outcome);
  cost.linearisations += report.iterations;
}

// Gives the log; false where the budget ran out.
bool feed(const MeasurementLog& log, Estimator& estimator, double budget_s, Run& run) {
  double spent_ms = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    const double start_ms = thread_ms();
    estimator.add_keyframe(arrival.step);
    if (!arrival.registrations.empty()) {
      note(estimator.close_loops(arrival.registrations), run.cost);
    }
    run.step_ms.push_back(thread_ms() - start_ms);
    spent_ms += run.step_ms.back();
    if (spent_ms > 1e3 * budget_s) return false;
  }
  return true;
}

std::optional<double> time_covariances(Estimator& estimator) {
  const double start_ms = thread_ms();
  for (std::size_t k = 0; k < estimator.size(); ++k) {
    if (!estimator.covariance(k)) return std::nullopt;
  }
  return thread_ms() - start_ms;
}

Run run_once(const MeasurementLog& log, const EstimatorEntry& entry, SolveMode mode,
             const Effort& effort) {
  Run run;
  const auto meter = make_memory_meter();
  if (meter) meter->start();
  const auto estimator = entry.create({log.origin(), mode}, {});
  run.cost.gave_up = !feed(log, *estimator, effort.budget_s, run);
  if (mode == SolveMode::batch) {
    const double start_ms = thread_ms();
    note(estimator->finish(), run.cost);
    run.cost.total_ms = thread_ms() - start_ms;
    run.cost.gave_up = run.cost.gave_up || run.cost.total_ms > 1e3 * effort.budget_s;
  } else {
    for (const double step_ms : run.step_ms) run.cost.total_ms += step_ms;
  }
  if (meter) run.cost.memory_mib = static_cast<double>(meter->stop()) / (1 << 20);
  if (run.cost.gave_up) return run;
  run.cost.chi2 = chi2(log, poses_of(*estimator));
  if (effort.covariances) run.cost.covariance_ms = time_covariances(*estimator);
  return run;
}

}  // namespace

Cost measure(const MeasurementLog& log, const EstimatorEntry& entry, SolveMode mode,
             const Effort& effort) {
  std::optional<Run> fastest;
  const double start_ms = thread_ms();
  for (int i = 0; i < effort.repeats; ++i) {
    Run run = run_once(log, entry, mode, effort);
    if (!fastest || run.cost.total_ms < fastest->cost.total_ms) fastest = std::move(run);
    if (thread_ms() - start_ms > 1e3 * effort.budget_s) break;
  }
  Cost cost = fastest->cost;
  cost.estimator = entry.name;
  cost.mode = mode;
  if (mode == SolveMode::incremental) cost.step_ms = summarise(fastest->step_ms);
  return cost;
}

}  // namespace fathom::benchmarks
