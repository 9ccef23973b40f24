// What the states of shared errors cost: pose graphs whose registrations tell what their pictures
// share, with shared_errors: states and independent, in batch and keyframe by keyframe. And what
// the estimate of the standard deviations of what they share costs (variance/…), from the odometry.
//
//     FATHOM_POSE_GRAPHS=FOLDER shared_errors_benchmark [--benchmark_filter=/intel/]
//
// For each g2o file of FOLDER, half of each registration's covariance is taken for its own; what a
// picture shares has the other half of the first registration's, in x, y and heading alike. Time is
// processor time of the thread, of everything from the first keyframe to the last.

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/variance_components.hpp"

namespace {

using fathom::MeasurementLog;
using fathom::PictureErrors;
using fathom::RelativePose;
using fathom::SharedErrors;
using fathom::SolveMode;

double thread_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

MeasurementLog told(const MeasurementLog& log) {
  MeasurementLog result(log.origin());
  PictureErrors shared{Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      const Eigen::Matrix3d covariance = z.covariance();
      if (shared.sigma.isZero(0.0)) shared.sigma = (0.25 * covariance.diagonal()).cwiseSqrt();
      const SharedErrors errors{shared, shared, 0.5 * covariance};
      RelativePose part = RelativePose::from_covariance(z.from, z.to, z.motion, errors.total());
      part.shared = std::make_shared<const SharedErrors>(errors);
      result.add_registration(part);
    }
  }
  return result;
}

void solve(benchmark::State& state, const MeasurementLog& log, const std::string& name,
           SolveMode mode, const std::string& model) {
  const fathom::EstimatorEntry& entry = fathom::builtin_estimators().find(name);
  const fathom::EstimatorValues values{{"shared_errors", fathom::OptionValue::scalar(model)}};
  for ([[maybe_unused]] auto _ : state) {
    const auto estimator = entry.create({log.origin(), mode}, values);
    const double start = thread_s();
    for (std::size_t k = 1; k < log.size(); ++k) {
      estimator->add_keyframe(log.arrival(k).step);
      if (log.arrival(k).registrations.empty()) continue;
      estimator->update({log.arrival(k).registrations});
    }
    if (mode == SolveMode::batch) estimator->finish({});
    state.SetIterationTime(thread_s() - start);
  }
}

void estimate_variance(benchmark::State& state, const MeasurementLog& log) {
  using Part = fathom::VarianceComponent::Part;
  const std::vector<fathom::VarianceComponent> components{{Part::altitude}, {Part::tilt}};
  const std::vector<fathom::Pose> start = log.odometry();
  for ([[maybe_unused]] auto _ : state) {
    const double begin = thread_s();
    benchmark::DoNotOptimize(fathom::estimate_variance(log, start, components));
    state.SetIterationTime(thread_s() - begin);
  }
}

void add(const std::string& graph, const std::shared_ptr<MeasurementLog>& log) {
  struct Case {
    const char* estimator;
    SolveMode mode;
    const char* name;
  };
  for (const Case& one : {Case{"sparse_gauss_newton", SolveMode::batch, "batch"},
                          Case{"ceres_pose_graph", SolveMode::batch, "batch"},
                          Case{"incremental_smoother", SolveMode::incremental, "incremental"},
                          Case{"sparse_gauss_newton", SolveMode::incremental, "incremental"}}) {
    for (const std::string model : {"independent", "states"}) {
      benchmark::RegisterBenchmark(
          (std::string(one.name) + "/" + graph + "/" + one.estimator + "/" + model).c_str(),
          [log, one, model](benchmark::State& state) {
            solve(state, *log, one.estimator, one.mode, model);
          })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RegisterBenchmark(("variance/" + graph).c_str(),
                               [log](benchmark::State& state) { estimate_variance(state, *log); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool registered = [] {
  const char* folder = std::getenv("FATHOM_POSE_GRAPHS");
  if (folder == nullptr) return false;
  std::map<std::string, std::shared_ptr<MeasurementLog>> logs;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".g2o") continue;
    logs[file.path().stem()] =
        std::make_shared<MeasurementLog>(told(fathom::read_g2o(file.path())));
  }
  for (const auto& [name, log] : logs) add(name, log);
  return true;
}();

}  // namespace
