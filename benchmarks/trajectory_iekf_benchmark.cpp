// What an update of the trajectory IEKF costs beside reading and writing the triangle of its
// covariance once, which no update of a dense covariance can do without.
//
//     trajectory_iekf_benchmark [--benchmark_filter=update]
//
// update/keyframes:N/linearisations:I  three loops, the longest back to keyframe 0, so that the
//     stretch is as long as the mission. `triangle_ms` is one pass x ← c x over as many numbers as
//     the triangle has, taken before each update; `per_triangle` the ratio of both medians,
//     `least` that of the least of both, for a machine that has other work.
// dsyrk/keyframes:N  the covariance update alone as a rank-9 update of BLAS, for comparison.
// mission/keyframes:N/updates:U/loops:L  a whole mission with U updates of L loops each, and
//     covariance(k) of all its keyframes at the end; `MB` is the memory of the covariance.
//
// Times are those of the thread, not of the wall: what else runs does not count, but for the share
// of the memory's speed that it takes.

#include <algorithm>
#include <cblas.h>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "benchmarks/noisy_motion.hpp"
#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace {

using fathom::MeasurementLog;
using fathom::Pose;
using fathom::RelativePose;

constexpr std::size_t kTimedUpdates = 100;  // the middle one at the keyframe that is named
constexpr std::size_t kRound = 60;          // keyframes in one round of the circle

constexpr double kStepSigmaM = 0.02;
constexpr double kStepSigmaRad = 0.002;
constexpr double kLoopSigmaM = 0.01;
constexpr double kLoopSigmaRad = 0.005;

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Pose true_pose(std::size_t k) {
  const double turn = 2.0 * M_PI * static_cast<double>(k) / static_cast<double>(kRound);
  const double radius_m = static_cast<double>(kRound) / (2.0 * M_PI);
  return {radius_m * std::sin(turn), radius_m * (1.0 - std::cos(turn)), fathom::wrap_angle(turn)};
}

RelativePose measure(std::size_t from, std::size_t to, double sigma_m, double sigma_rad,
                     fathom::RandomStream& noise) {
  return fathom::benchmarks::noisy_motion(from, true_pose(from), to, true_pose(to), sigma_m,
                                          sigma_rad, noise);
}

// `loops` registrations of keyframe k, one of them to keyframe 0.
std::vector<RelativePose> registrations(std::size_t k, std::size_t loops,
                                        fathom::RandomStream& noise) {
  std::vector<RelativePose> result;
  for (std::size_t j = 0; j < loops; ++j) {
    result.push_back(measure(j * k / loops, k, kLoopSigmaM, kLoopSigmaRad, noise));
  }
  return result;
}

// One pass over the numbers of a triangle, each read and written.
class Triangle {
 public:
  explicit Triangle(std::size_t keyframes) : numbers_(3 * keyframes * (3 * keyframes + 1) / 2, 1) {}

  double pass_ms() {
    const double start = thread_ms();
    for (double& number : numbers_) number *= 1.0000001;
    benchmark::DoNotOptimize(numbers_.data());
    benchmark::ClobberMemory();
    return thread_ms() - start;
  }

 private:
  std::vector<double> numbers_;
};

fathom::TrajectoryIekf filter(std::int64_t linearisations) {
  fathom::TrajectoryIekfOptions options;
  options.max_iterations = static_cast<int>(linearisations);
  options.tolerance = 1e-300;
  return {{}, options};
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

void report(benchmark::State& state, const std::vector<double>& times_ms,
            const std::vector<double>& triangles_ms) {
  state.counters["median_ms"] = median(times_ms);
  state.counters["triangle_ms"] = median(triangles_ms);
  state.counters["per_triangle"] = median(times_ms) / median(triangles_ms);
  state.counters["least"] = least(times_ms) / least(triangles_ms);
}

// An estimator cannot be set back: the state grows by one keyframe from update to update.
void update(benchmark::State& state) {
  const auto keyframes = static_cast<std::size_t>(state.range(0));
  fathom::RandomStream noise(1, "survey");
  fathom::TrajectoryIekf estimator = filter(state.range(1));
  Triangle triangle(keyframes);
  std::size_t k = 1;
  const auto advance = [&] {
    estimator.add_keyframe(measure(k - 1, k, kStepSigmaM, kStepSigmaRad, noise));
    return registrations(k++, 3, noise);
  };
  while (k + kTimedUpdates / 2 < keyframes) {
    const std::vector<RelativePose> loops = advance();
    if (k % 5 == 0) estimator.close_loops(loops);
  }
  std::vector<double> times_ms;
  std::vector<double> triangles_ms;
  for ([[maybe_unused]] auto _ : state) {
    const std::vector<RelativePose> loops = advance();
    triangles_ms.push_back(triangle.pass_ms());
    const double start = thread_ms();
    const fathom::UpdateReport update = estimator.close_loops(loops);
    times_ms.push_back(thread_ms() - start);
    state.SetIterationTime(1e-3 * times_ms.back());
    if (!is_done(update.outcome) || update.iterations != state.range(1)) {
      state.SkipWithError(("update ended as " + name_of(update.outcome)).c_str());
      break;
    }
  }
  report(state, times_ms, triangles_ms);
}

void dsyrk(benchmark::State& state) {
  const auto n = static_cast<int>(3 * state.range(0));
  Triangle triangle(static_cast<std::size_t>(state.range(0)));
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(n, n);
  const Eigen::MatrixXd W = 1e-3 * Eigen::MatrixXd::Random(9, n);
  std::vector<double> times_ms;
  std::vector<double> triangles_ms;
  for ([[maybe_unused]] auto _ : state) {
    triangles_ms.push_back(triangle.pass_ms());
    const double start = thread_ms();
    cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, 9, -1.0, W.data(), 9, 1.0, P.data(), n);
    times_ms.push_back(thread_ms() - start);
    state.SetIterationTime(1e-3 * times_ms.back());
  }
  report(state, times_ms, triangles_ms);
}

// Updates stand evenly over the mission, the last at its last keyframe.
void mission(benchmark::State& state) {
  const auto keyframes = static_cast<std::size_t>(state.range(0));
  const auto updates = static_cast<std::size_t>(state.range(1));
  const auto loops = static_cast<std::size_t>(state.range(2));
  for ([[maybe_unused]] auto _ : state) {
    fathom::RandomStream noise(1, "survey");
    fathom::TrajectoryIekf estimator = filter(3);
    double longest_ms = 0.0;
    double sum_ms = 0.0;
    for (std::size_t k = 1; k < keyframes; ++k) {
      estimator.add_keyframe(measure(k - 1, k, kStepSigmaM, kStepSigmaRad, noise));
      if ((k * updates) / (keyframes - 1) == ((k - 1) * updates) / (keyframes - 1)) continue;
      const std::vector<RelativePose> closed = registrations(k, loops, noise);
      const double start = thread_ms();
      const fathom::UpdateReport update = estimator.close_loops(closed);
      const double time_ms = thread_ms() - start;
      sum_ms += time_ms;
      longest_ms = std::max(longest_ms, time_ms);
      if (!is_done(update.outcome)) state.SkipWithError("an update failed");
    }
    const double start = thread_ms();
    benchmark::DoNotOptimize(estimator.covariance(keyframes - 1));
    state.counters["covariances_ms"] = thread_ms() - start;
    state.counters["MB"] = 1e-6 * static_cast<double>(estimator.state_covariance().bytes());
    state.counters["dense_motions"] =
        static_cast<double>(estimator.state_covariance().dense_motions());
    state.counters["updates_ms"] = sum_ms;
    state.counters["longest_ms"] = longest_ms;
    state.SetIterationTime(1e-3 * sum_ms);
  }
}

BENCHMARK(update)
    ->ArgNames({"keyframes", "linearisations"})
    ->ArgsProduct({{300, 1000}, {1, 2, 3}})
    ->Iterations(kTimedUpdates)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

BENCHMARK(dsyrk)
    ->ArgName("keyframes")
    ->Arg(300)
    ->Arg(1000)
    ->Iterations(kTimedUpdates)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

BENCHMARK(mission)
    ->ArgNames({"keyframes", "updates", "loops"})
    ->Args({1000, 100, 3})
    ->Args({1000, 900, 1})
    ->Args({10000, 100, 3})
    ->Args({10000, 300, 1})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
