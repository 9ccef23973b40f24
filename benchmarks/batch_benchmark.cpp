// One batch solve of sparse_gauss_newton from dead reckoning, on one thread and on two: wall time
// of finish() alone. The survey is that of `back_ends --growth`, a loop for every third keyframe.
//
//     batch_benchmark [--benchmark_filter=keyframes:100000]
//
// Every solve is of a new estimator, as a user's is: its memory has not been touched before.

#include <chrono>
#include <cstddef>
#include <string>

#include <benchmark/benchmark.h>

#include "benchmarks/back_ends/survey.hpp"
#include "fathom/estimators/builtin.hpp"

namespace {

void solve(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const auto keyframes = static_cast<std::size_t>(state.range(0));
  const fathom::MeasurementLog log = fathom::benchmarks::parallel_tracks(keyframes, keyframes / 3);
  const fathom::EstimatorRegistry& registry = fathom::builtin_estimators();
  const fathom::EstimatorValues values{
      {"threads", fathom::OptionValue::scalar(std::to_string(state.range(1)))}};
  for ([[maybe_unused]] auto _ : state) {
    const auto estimator = registry.find("sparse_gauss_newton")
                               .create({log.origin(), fathom::SolveMode::batch}, values);
    for (std::size_t k = 1; k < log.size(); ++k) {
      estimator->add_keyframe(log.arrival(k).step);
      if (log.arrival(k).registrations.empty()) continue;
      estimator->update({log.arrival(k).registrations});
    }
    const auto start = Clock::now();
    const fathom::UpdateReport report = estimator->finish({});
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
    if (!is_done(report.outcome)) {
      state.SkipWithError(("solve ended as " + name_of(report.outcome)).c_str());
      break;
    }
  }
}

BENCHMARK(solve)
    ->ArgNames({"keyframes", "threads"})
    ->ArgsProduct({{3000, 10000, 100000}, {1, 2}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
