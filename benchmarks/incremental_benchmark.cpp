// Whole pose graphs keyframe by keyframe, as they arrive: incremental_smoother beside
// sparse_gauss_newton, which solves the whole graph whenever loops arrive.
//
//     FATHOM_POSE_GRAPHS=FOLDER incremental_benchmark [--benchmark_filter=intel]
//
// For each g2o file of FOLDER: what all keyframes took (`total_ms`), and of one keyframe the
// median, the 95 % quantile and the longest, as CPU time of the thread, of each keyframe the least
// of all repetitions; chi2 at the end; and the largest share by which chi2 exceeded the optimum of
// a batch solve of the same measurements, over every 100th keyframe (`worst_gap`; an optimum below
// 1e-4 counts as 1e-4). `scale` is the time of Ceres for the whole graph in batch, of Gauss-Newton
// steps from dead reckoning to 1e-6 of the optimum, by which figures of two machines can be
// compared.

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/g2o.hpp"

namespace {

using fathom::Estimator;
using fathom::MeasurementLog;
using fathom::SolveMode;

constexpr std::size_t kCheckEvery = 100;
constexpr double kLeastOptimum = 1e-4;

double thread_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void arrive(Estimator& estimator, const MeasurementLog& log, std::size_t k) {
  estimator.add_keyframe(log.arrival(k).step);
  if (!log.arrival(k).registrations.empty()) estimator.update({log.arrival(k).registrations});
}

MeasurementLog prefix_of(const MeasurementLog& log, std::size_t last) {
  MeasurementLog prefix(log.origin());
  for (std::size_t k = 1; k <= last; ++k) {
    prefix.add_keyframe(log.arrival(k).step);
    for (const auto& z : log.arrival(k).registrations) prefix.add_registration(z);
  }
  return prefix;
}

double optimum_of(const MeasurementLog& log) {
  const auto batch = fathom::builtin_estimators()
                         .find("sparse_gauss_newton")
                         .create({log.origin(), SolveMode::batch}, {});
  for (std::size_t k = 1; k < log.size(); ++k) arrive(*batch, log, k);
  batch->finish();
  return chi2(log, poses_of(*batch));
}

double worst_gap(const MeasurementLog& log, const fathom::EstimatorEntry& entry) {
  const auto estimator = entry.create({log.origin()}, {});
  double worst = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*estimator, log, k);
    if (k % kCheckEvery != 0 && k + 1 != log.size()) continue;
    const MeasurementLog prefix = prefix_of(log, k);
    const double optimum = optimum_of(prefix);
    const double gap = chi2(prefix, poses_of(*estimator)) - optimum;
    worst = std::max(worst, gap / std::max(optimum, kLeastOptimum));
  }
  return worst;
}

void incremental(benchmark::State& state, const MeasurementLog& log, const std::string& name) {
  const fathom::EstimatorEntry& entry = fathom::builtin_estimators().find(name);
  std::vector<double> step_ms(log.size() - 1, 1e9);
  double cost = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const auto estimator = entry.create({log.origin()}, {});
    double total_s = 0.0;
    for (std::size_t k = 1; k < log.size(); ++k) {
      const double start = thread_s();
      arrive(*estimator, log, k);
      const double took_s = thread_s() - start;
      total_s += took_s;
      step_ms[k - 1] = std::min(step_ms[k - 1], 1e3 * took_s);
    }
    state.SetIterationTime(total_s);
    cost = chi2(log, poses_of(*estimator));
  }
  state.counters["total_ms"] = std::accumulate(step_ms.begin(), step_ms.end(), 0.0);
  std::sort(step_ms.begin(), step_ms.end());
  state.counters["median_ms"] = step_ms[step_ms.size() / 2];
  state.counters["p95_ms"] = step_ms[step_ms.size() * 95 / 100];
  state.counters["longest_ms"] = step_ms.back();
  state.counters["chi2"] = cost;
  state.counters["worst_gap"] = worst_gap(log, entry);
}

void scale(benchmark::State& state, const MeasurementLog& log) {
  double least_s = 1e9;
  for ([[maybe_unused]] auto _ : state) {
    const auto batch = fathom::builtin_estimators()
                           .find("ceres_pose_graph")
                           .create({log.origin(), SolveMode::batch},
                                   {{"tolerance", fathom::OptionValue::scalar("1e-6")}});
    for (std::size_t k = 1; k < log.size(); ++k) arrive(*batch, log, k);
    const double start = thread_s();
    batch->finish();
    const double took_s = thread_s() - start;
    least_s = std::min(least_s, took_s);
    state.SetIterationTime(took_s);
  }
  state.counters["cpu_ms"] = 1e3 * least_s;
}

void add_files(const std::filesystem::path& folder) {
  std::map<std::string, std::shared_ptr<MeasurementLog>> logs;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".g2o") continue;
    logs[file.path().stem()] = std::make_shared<MeasurementLog>(fathom::read_g2o(file.path()));
  }
  for (const auto& [name, log] : logs) {
    benchmark::RegisterBenchmark(("scale/" + name).c_str(),
                                 [log = log](benchmark::State& state) { scale(state, *log); })
        ->Iterations(15)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
    for (const std::string estimator : {"sparse_gauss_newton", "incremental_smoother"}) {
      benchmark::RegisterBenchmark(
          ("incremental/" + name + "/" + estimator).c_str(),
          [log = log, estimator](benchmark::State& state) { incremental(state, *log, estimator); })
          ->Iterations(3)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

[[maybe_unused]] const bool registered = [] {
  if (const char* folder = std::getenv("FATHOM_POSE_GRAPHS")) add_files(folder);
  return true;
}();

}  // namespace
