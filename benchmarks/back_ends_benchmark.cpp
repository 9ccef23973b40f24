// What an update costs with each registered estimator, its options at their defaults, against the
// number of keyframes in its state. Time is that of close_loops alone; of `NAME/motions`, that of
// the motions to the newest keyframe with their covariances, which loop candidates by uncertainty
// take.
//
//     back_ends_benchmark [--benchmark_filter=ekf/]
//
// An estimator cannot be set back, so the state grows by one keyframe from update to update: what
// is printed for 300 keyframes is the mean over the updates at keyframes 300 to 319.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <benchmark/benchmark.h>

#include "benchmarks/noisy_motion.hpp"
#include "fathom/core/random.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace {

using fathom::MeasurementLog;
using fathom::Pose;
using fathom::RelativePose;

constexpr std::size_t kTimedUpdates = 20;
constexpr std::size_t kLoopsPerUpdate = 3;

// Five legs of ten keyframes, flown there and back, again and again.
constexpr std::size_t kLegKeyframes = 10;
constexpr std::size_t kPassKeyframes = 50;
constexpr double kKeyframeSpacingM = 1.0;
constexpr double kLegSpacingM = 2.0;

// Before the timed part every so many keyframes close loops: a survey that is well tied together.
constexpr std::size_t kLoopEvery = 5;

constexpr double kStepSigmaM = 0.02;
constexpr double kStepSigmaRad = 0.005;
constexpr double kLoopSigmaM = 0.01;
constexpr double kLoopSigmaRad = 0.005;

// The keyframe of the first pass at the same place as keyframe k.
std::size_t first_visit(std::size_t k) {
  const std::size_t along = k % kPassKeyframes;
  const bool on_the_way_back = (k / kPassKeyframes) % 2 == 1;
  return on_the_way_back ? kPassKeyframes - 1 - along : along;
}

Pose true_pose(std::size_t k) {
  const std::size_t place = first_visit(k);
  const std::size_t leg = place / kLegKeyframes;
  const std::size_t along = place % kLegKeyframes;
  const bool against_x = leg % 2 == 1;
  const bool turned_round = against_x != ((k / kPassKeyframes) % 2 == 1);
  const std::size_t x = against_x ? kLegKeyframes - 1 - along : along;
  return {kKeyframeSpacingM * static_cast<double>(x), kLegSpacingM * static_cast<double>(leg),
          turned_round ? M_PI : 0.0};
}

RelativePose measure(std::size_t from, std::size_t to, double sigma_m, double sigma_rad,
                     fathom::RandomStream& noise) {
  return fathom::benchmarks::noisy_motion(from, true_pose(from), to, true_pose(to), sigma_m,
                                          sigma_rad, noise);
}

// The last kTimedUpdates keyframes and every kLoopEvery-th one from the second pass on close
// kLoopsPerUpdate loops each, to where the first pass came by: as far back as loops go.
MeasurementLog survey(std::size_t keyframes) {
  fathom::RandomStream steps(1, "steps");
  fathom::RandomStream loops(1, "loops");
  const std::size_t size = keyframes + kTimedUpdates;
  MeasurementLog log(true_pose(0));
  for (std::size_t k = 1; k < size; ++k) {
    log.add_keyframe(measure(k - 1, k, kStepSigmaM, kStepSigmaRad, steps));
    const bool is_due = k >= kPassKeyframes && k % kLoopEvery == 0;
    if (!is_due && k < keyframes) continue;
    const std::size_t first = std::min(first_visit(k), kPassKeyframes - kLoopsPerUpdate);
    for (std::size_t from = first; from < first + kLoopsPerUpdate; ++from) {
      log.add_registration(measure(from, k, kLoopSigmaM, kLoopSigmaRad, loops));
    }
  }
  return log;
}

void update(benchmark::State& state, const fathom::EstimatorEntry& entry) {
  using Clock = std::chrono::steady_clock;
  const auto keyframes = static_cast<std::size_t>(state.range(0));
  const MeasurementLog log = survey(keyframes);
  const auto estimator = entry.create({log.origin()}, {});
  std::size_t k = 1;
  for (; k < keyframes; ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty()) continue;
    estimator->update({log.arrival(k).registrations});
  }
  int linearisations = 0;
  for ([[maybe_unused]] auto _ : state) {
    estimator->add_keyframe(log.arrival(k).step);
    const auto start = Clock::now();
    const fathom::UpdateReport report = estimator->update({log.arrival(k).registrations});
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
    linearisations += report.iterations;
    ++k;
    if (!is_done(report.outcome)) {
      state.SkipWithError(("update ended as " + name_of(report.outcome)).c_str());
      break;
    }
  }
  state.counters["linearisations"] =
      benchmark::Counter(linearisations, benchmark::Counter::kAvgIterations);
}

void motions(benchmark::State& state, const fathom::EstimatorEntry& entry) {
  const MeasurementLog log = survey(static_cast<std::size_t>(state.range(0)));
  const auto estimator = entry.create({log.origin()}, {});
  for (std::size_t k = 1; k < log.size(); ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    estimator->update({log.arrival(k).registrations});
  }
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(estimator->motions_to_newest());
}

void register_all() {
  for (const fathom::EstimatorEntry& entry : fathom::builtin_estimators().entries()) {
    benchmark::RegisterBenchmark(entry.name.c_str(),
                                 [&entry](benchmark::State& state) { update(state, entry); })
        ->ArgName("keyframes")
        ->Arg(100)
        ->Arg(300)
        ->Arg(1000)
        ->Iterations(kTimedUpdates)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark((entry.name + "/motions").c_str(),
                                 [&entry](benchmark::State& state) { motions(state, entry); })
        ->ArgName("keyframes")
        ->Arg(100)
        ->Arg(300)
        ->Arg(1000)
        ->Unit(benchmark::kMillisecond);
  }
}

[[maybe_unused]] const bool registered = (register_all(), true);

}  // namespace
