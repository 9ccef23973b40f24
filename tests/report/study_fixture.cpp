#include "report/study_fixture.hpp"

#include <cmath>
#include <limits>
#include <random>

namespace fathom::test {
namespace {

using Series = std::vector<double>;

struct Path {
  Series x;
  Series y;
  Series theta;
};

// Lines of ten keyframes, to and fro, 1 m apart.
Path lawnmower(std::size_t keyframes) {
  Path path;
  for (std::size_t k = 0; k < keyframes; ++k) {
    const std::size_t line = k / 10;
    const auto along = static_cast<double>(k % 10);
    const bool back = line % 2 == 1;
    path.x.push_back(back ? 9.0 - along : along);
    path.y.push_back(0.8 * static_cast<double>(line));
    path.theta.push_back(back ? 3.0 : 0.0);
  }
  return path;
}

struct Character {
  double step_sigma_m;  ///< of the walk of errors
  double stated;        ///< stated σ by the true one
  double update_ms;
};

Character character_of(const std::string& estimator) {
  if (estimator == kDeadReckoning) return {0.12, 1.0, 0.0};
  if (estimator == "iterated") return {0.02, 1.0, 4.0};
  if (estimator == "graph") return {0.04, 1.1, 0.7};
  return {0.03, 0.5, 1.5};
}

void add_path(RunRecord& run, const Path& truth, const Character& character, double scale,
              std::mt19937& random, bool judged) {
  std::normal_distribution<double> normal;
  const double sigma_m = character.step_sigma_m * scale;
  double ex = 0.0;
  double ey = 0.0;
  for (std::size_t k = 0; k < truth.x.size(); ++k) {
    const double variance = sigma_m * sigma_m * static_cast<double>(k);
    if (k > 0) {
      ex += sigma_m * normal(random);
      ey += sigma_m * normal(random);
    }
    const double stated = variance * character.stated * character.stated;
    run.series["x_m"].push_back(truth.x[k] + ex);
    run.series["y_m"].push_back(truth.y[k] + ey);
    run.series["theta_rad"].push_back(truth.theta[k]);
    run.series["time_s"].push_back(static_cast<double>(k));
    if (run.key.estimator != kDeadReckoning) {
      run.series["cov_xx"].push_back(stated);
      run.series["cov_xy"].push_back(0.3 * stated);
      run.series["cov_yy"].push_back(stated);
    }
    if (!judged) continue;
    run.series["position_error_m"].push_back(std::hypot(ex, ey));
    run.series["heading_error_rad"].push_back(0.01 * normal(random));
    if (k > 0 && run.key.estimator != kDeadReckoning) {
      const double along = normal(random);
      run.series["pose_nees"].push_back((ex * ex + ey * ey) / stated + along * along);
      run.series["position_nees"].push_back((ex * ex + ey * ey) / stated);
    }
  }
}

void add_loops(RunRecord& run, std::size_t keyframes, double update_ms) {
  for (std::size_t k = 10; k < keyframes; ++k) {
    const std::size_t across = k - 1 - 2 * (k % 10);
    run.series["loop_from"].push_back(static_cast<double>(across));
    run.series["loop_to"].push_back(static_cast<double>(k));
    run.series["loop_fate"].push_back(k % 13 == 0 ? 1.0 : k % 29 == 0 ? 2.0 : 0.0);
    run.series["loop_nis"].push_back(k % 2 == 0 ? 2.5 : -1.0);
    run.series["update_keyframe"].push_back(static_cast<double>(k));
    run.series["update_ms"].push_back(update_ms * (1.0 + 0.02 * static_cast<double>(k * k)));
  }
}

void add_absolute(RunRecord& run, const Path& truth, bool is_old) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto put = [&run](const char* name, double value) {
    run.series["absolute_" + std::string(name)].push_back(value);
  };
  const auto add = [&](std::size_t k, bool is_fix, bool is_wrong) {
    const bool is_rejected = is_wrong && run.key.estimator == "iterated";
    const bool is_weak = is_wrong && run.key.estimator == "graph";
    put("keyframe", static_cast<double>(k));
    put("fate", is_rejected ? 1.0 : 0.0);
    put("nis", run.key.estimator == "graph" ? -1.0 : is_wrong ? 400.0 : 1.5);
    put("weight", is_rejected ? 0.0 : is_weak ? 0.1 : 1.0);
    if (is_old) return;
    put("x_m", is_fix ? truth.x[k] + (is_wrong ? 2.0 : 0.0) : kNone);
    put("y_m", is_fix ? truth.y[k] + (is_wrong ? 1.0 : 0.0) : kNone);
    put("cov_xx", is_fix ? 0.25 : kNone);
    put("cov_xy", is_fix ? 0.0 : kNone);
    put("cov_yy", is_fix ? 0.0625 : kNone);
    put("theta_rad", is_fix ? kNone : truth.theta[k] + (is_wrong ? 0.5 * M_PI : 0.0));
    put("sigma_rad", is_fix ? kNone : 0.1);
  };
  for (std::size_t k = 0; k < truth.x.size(); ++k) {
    if (k % 5 == 0) add(k, true, k == 20);
    add(k, false, k == 12);
  }
}

double mean_of(const Series& series) {
  double sum = 0.0;
  for (const double value : series) sum += value;
  return sum / static_cast<double>(series.size());
}

void add_metrics(RunRecord& run, const Character& character, std::mt19937& random) {
  std::normal_distribution<double> normal;
  if (run.series.contains("position_error_m")) {
    const Series& errors = run.series["position_error_m"];
    run.metrics["mean_position_error_m"] = mean_of(errors);
    run.metrics["ate_rmse_m"] = 1.1 * mean_of(errors);
    run.metrics["final_position_error_m"] = errors.back();
    run.metrics["rpe_10_keyframes_m"] = 0.3 * mean_of(errors);
  }
  if (run.key.estimator == kDeadReckoning) return;
  if (run.series.contains("pose_nees")) {
    run.metrics["anees"] = mean_of(run.series["pose_nees"]) / 3.0;
  }
  run.metrics["chi2"] = 100.0 + normal(random);
  run.metrics["total_ms"] = 40.0 * character.update_ms * (1.0 + 0.05 * std::abs(normal(random)));
  run.metrics["memory_bytes"] = 1e6 * character.update_ms;
  if (run.series.contains("update_ms")) {
    run.metrics["update_ms.median"] = mean_of(run.series["update_ms"]);
  }
}

RunRecord fixture_run(const RunKey& key, const FixtureOptions& options, std::size_t cells) {
  RunRecord run;
  run.key = key;
  run.log_hash =
      std::to_string(key.cell) + "-" + std::to_string(key.survey) + "-" + std::to_string(key.trial);
  run.jobs = options.jobs;
  run.metrics["keyframes"] = static_cast<double>(options.keyframes);
  const bool baseline = key.estimator == kDeadReckoning;
  if (!baseline) run.outcome = "converged";
  const bool last = key.cell + 1 == cells;
  if (last && key.estimator == "graph" && key.trial == 0) run.outcome = "iteration_limit";
  if (last && key.estimator == "a&b_<c>%" && key.trial < 2 && cells > 1) {
    run.outcome = key.trial == 0 ? "diverged" : "numerical_failure";
    return run;
  }
  std::mt19937 random(static_cast<unsigned>(1000 * key.cell + 100 * key.survey + key.trial) +
                      key.estimator.size());
  const Path truth = lawnmower(options.keyframes);
  const Character character = character_of(key.estimator);
  const double size = options.size * (baseline ? options.baseline : 1.0);
  add_path(run, truth, character, size * (1.0 + static_cast<double>(key.cell)), random,
           options.ground_truth);
  if (!baseline && options.loops) add_loops(run, options.keyframes, character.update_ms);
  if (!baseline && options.absolute) add_absolute(run, truth, options.absolute_is_old);
  if (baseline && options.ground_truth) {
    run.series["truth_x_m"] = truth.x;
    run.series["truth_y_m"] = truth.y;
    run.series["truth_theta_rad"] = truth.theta;
  }
  add_metrics(run, character, random);
  if (options.misfit && key.cell == 0 && !baseline) {
    run.metrics["degrees_of_freedom"] = 90.0;
    run.metrics["chi2_optimum"] = 4.0 * 90.0;
    run.metrics["chi2"] += 4.0 * 90.0;
  }
  return run;
}

}  // namespace

StudyDescription fixture_study(const FixtureOptions& options) {
  StudyDescription study;
  study.title = "Loops & <noise>: 50 % of a_b </script>";
  study.alignment = "origin";
  study.surveys = options.surveys;
  study.trials = options.trials;
  if (!options.separations.empty()) {
    study.axes.push_back(
        {"separation", "front_end.keyframes.separation_frames", options.separations});
  }
  if (!options.noises.empty()) {
    study.axes.push_back({options.noise_name, "dataset.odometry.covariance", options.noises});
  }
  if (!options.alignments.empty()) {
    study.axes.push_back({"aligned by", "evaluation.alignment", options.alignments});
  }
  study.estimators = {
      {"iterated", "trajectory_iekf"}, {"a&b_<c>%", "ekf"}, {"graph", "ceres_pose_graph"}};
  study.metrics = {"mean_position_error_m", "rpe_10_keyframes_m", "anees", "total_ms"};
  if (options.misfit) study.metrics.insert(study.metrics.begin(), "chi2");
  study.configuration = {{"association.mode", "shared"},
                         {"seed", "1"},
                         {"dataset.path", "a,b \"c\" <d>"},
                         {"dataset.type", options.data_set}};
  return study;
}

void write_fixture(const std::filesystem::path& folder, const FixtureOptions& options) {
  const StudyDescription study = fixture_study(options);
  ResultStore store = ResultStore::write(
      folder, study,
      R"({"fathom": "0.1.0", "date": "2026-01-02T03:04:05Z", "machine": {"cpu": "<Two> & a half"}})");
  for (std::size_t cell = 0; cell < study.cell_count(); ++cell) {
    for (std::size_t i = 0; i < options.surveys * options.trials; ++i) {
      for (const char* name : {kDeadReckoning, "iterated", "a&b_<c>%", "graph"}) {
        const RunKey key{cell, i / options.trials, i % options.trials, name};
        store.add(fixture_run(key, options, study.cell_count()));
      }
    }
  }
  store.finish();
}

}  // namespace fathom::test
