// Whole pose graphs in batch, sparse_gauss_newton beside ceres_pose_graph (its default: an initial
// trust region of 1e16, so Gauss-Newton), both from dead reckoning to the optimum, and the
// covariances of all keyframes after it. Time is that of finish(), or of the covariances; what it
// takes to hand the log over is `feed_ms`. `cpu_ms` and `feed_ms` are the least CPU time of the
// thread.
//
//     FATHOM_POSE_GRAPHS=FOLDER pose_graphs_benchmark [--benchmark_filter=intel]
//
// With the g2o files of FOLDER, and with a simulated survey of parallel tracks, each with loops to
// its neighbour, of 1000 to 100000 keyframes.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "fathom/core/random.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/g2o.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using fathom::MeasurementLog;
using fathom::Pose;
using fathom::RelativePose;

// Wall time, and that of the thread alone, which others on the machine disturb less.
class Stopwatch {
 public:
  double wall_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  double cpu_s() const { return thread_s() - thread_start_; }

 private:
  static double thread_s() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double thread_start_ = thread_s();
  Clock::time_point start_ = Clock::now();
};

std::size_t root_of(std::size_t keyframes) {
  return static_cast<std::size_t>(std::sqrt(static_cast<double>(keyframes)));
}

// As many tracks as keyframes on each, there and back.
Pose true_pose(std::size_t k, std::size_t along_track) {
  const std::size_t track = k / along_track;
  const std::size_t along = k % along_track;
  const bool back = track % 2 == 1;
  const std::size_t x = back ? along_track - 1 - along : along;
  return {static_cast<double>(x), 2.0 * static_cast<double>(track), back ? M_PI : 0.0};
}

RelativePose measure(const Pose& a, const Pose& b, std::size_t from, std::size_t to, double sigma_m,
                     double sigma_rad, fathom::RandomStream& noise) {
  Pose motion = between(a, b);
  motion.x += sigma_m * noise.normal();
  motion.y += sigma_m * noise.normal();
  motion.theta = fathom::wrap_angle(motion.theta + sigma_rad * noise.normal());
  const Eigen::Vector3d variances{sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad};
  return RelativePose::from_covariance(from, to, motion, variances.asDiagonal());
}

// Every third keyframe sees the one beside it on the track before.
MeasurementLog survey(std::size_t keyframes) {
  fathom::RandomStream noise(1, "survey");
  const std::size_t along_track = root_of(keyframes);
  MeasurementLog log(true_pose(0, along_track));
  for (std::size_t k = 1; k < keyframes; ++k) {
    const Pose here = true_pose(k, along_track);
    log.add_keyframe(measure(true_pose(k - 1, along_track), here, k - 1, k, 0.02, 0.005, noise));
    const std::size_t back = 2 * (k % along_track) + 1;
    if (k < along_track || k % 3 != 0) continue;
    log.add_registration(
        measure(true_pose(k - back, along_track), here, k - back, k, 0.03, 0.01, noise));
  }
  return log;
}

std::unique_ptr<fathom::Estimator> fed(const MeasurementLog& log,
                                       const fathom::EstimatorEntry& entry,
                                       const fathom::EstimatorValues& values) {
  auto estimator = entry.create({log.origin(), fathom::SolveMode::batch}, values);
  for (std::size_t k = 1; k < log.size(); ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty()) continue;
    estimator->close_loops(log.arrival(k).registrations);
  }
  return estimator;
}

struct Solver {
  std::string name;
  std::string estimator;
  fathom::EstimatorValues values;
};

std::vector<Solver> solvers() {
  const auto tolerance = [](const std::string& value) {
    return fathom::EstimatorValues{{"tolerance", fathom::OptionValue::scalar(value)}};
  };
  return {{"sparse_gauss_newton", "sparse_gauss_newton", {}},
          {"ceres_pose_graph", "ceres_pose_graph", {}},
          // To 1e-6 of the optimum, no further.
          {"ceres_pose_graph_1e-6", "ceres_pose_graph", tolerance("1e-6")}};
}

void solve(benchmark::State& state, const MeasurementLog& log, const Solver& solver) {
  const fathom::EstimatorEntry& entry = fathom::builtin_estimators().find(solver.estimator);
  double feed_s = 1e9;
  double fastest_s = 1e9;
  int iterations = 0;
  double cost = 0.0;
  for (auto _ : state) {
    const Stopwatch feeding;
    const auto estimator = fed(log, entry, solver.values);
    feed_s = std::min(feed_s, feeding.cpu_s());
    const Stopwatch solving;
    const fathom::UpdateReport report = estimator->finish();
    fastest_s = std::min(fastest_s, solving.cpu_s());
    state.SetIterationTime(solving.wall_s());
    iterations = report.iterations;
    cost = chi2(log, poses_of(*estimator));
  }
  state.counters["cpu_ms"] = 1e3 * fastest_s;
  state.counters["feed_ms"] = 1e3 * feed_s;
  state.counters["linearisations"] = iterations;
  state.counters["chi2"] = cost;
}

void covariances(benchmark::State& state, const MeasurementLog& log, const Solver& solver) {
  const fathom::EstimatorEntry& entry = fathom::builtin_estimators().find(solver.estimator);
  double fastest_s = 1e9;
  for (auto _ : state) {
    const auto estimator = fed(log, entry, solver.values);
    estimator->finish();
    const Stopwatch asking;
    for (std::size_t k = 0; k < log.size(); ++k) {
      benchmark::DoNotOptimize(estimator->covariance(k));
    }
    fastest_s = std::min(fastest_s, asking.cpu_s());
    state.SetIterationTime(asking.wall_s());
  }
  state.counters["cpu_ms"] = 1e3 * fastest_s;
}

using Run = void (*)(benchmark::State&, const MeasurementLog&, const Solver&);

void add(const std::string& name, Run run, const std::shared_ptr<MeasurementLog>& log,
         const Solver& solver, int repetitions) {
  benchmark::RegisterBenchmark(
      (name + "/" + solver.name).c_str(),
      [run, log, solver](benchmark::State& state) { run(state, *log, solver); })
      ->Iterations(repetitions)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

void add_files(const std::filesystem::path& folder) {
  std::map<std::string, std::shared_ptr<MeasurementLog>> logs;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".g2o") continue;
    logs[file.path().stem()] = std::make_shared<MeasurementLog>(fathom::read_g2o(file.path()));
  }
  for (const auto& [name, log] : logs) {
    for (const Solver& solver : solvers()) add("solve/" + name, solve, log, solver, 15);
  }
  for (const auto& [name, log] : logs) {
    add("covariances/" + name, covariances, log, solvers()[0], 5);
  }
}

void add_surveys() {
  for (const std::size_t keyframes : {1000, 3000, 10000, 30000, 100000}) {
    const auto log = std::make_shared<MeasurementLog>(survey(keyframes));
    for (const Solver& solver : solvers()) {
      add("survey/" + std::to_string(keyframes), solve, log, solver, 3);
    }
    add("survey_covariances/" + std::to_string(keyframes), covariances, log, solvers()[0], 3);
  }
}

[[maybe_unused]] const bool registered = [] {
  if (const char* folder = std::getenv("FATHOM_POSE_GRAPHS")) add_files(folder);
  add_surveys();
  return true;
}();

}  // namespace
