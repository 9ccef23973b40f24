#include "fathom/harness/run_record.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "fathom/core/hash.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom {
namespace {

void put(RunRecord& run, const std::string& name, double value) {
  if (std::isfinite(value)) run.metrics[name] = value;
}

void put(RunRecord& run, const std::string& name, const std::optional<double>& value) {
  if (value) put(run, name, *value);
}

void put_summary(RunRecord& run, const std::string& name, const std::vector<double>& values) {
  const auto summary = summarise(values);
  if (!summary) return;
  put(run, name + ".median", summary->median);
  put(run, name + ".p95", summary->p95);
  put(run, name + ".max", summary->max);
  put(run, name + ".total", summary->total);
}

void put_relative(RunRecord& run, const std::string& name,
                  const std::optional<RelativeError>& error) {
  if (!error) return;
  put(run, name + "_m", error->translation_rmse_m);
  put(run, name + "_rad", error->rotation_rmse_rad);
}

void put_poses(RunRecord& run, const std::string& prefix, const std::vector<Pose>& poses) {
  std::vector<double>& x = run.series[prefix + "x_m"];
  std::vector<double>& y = run.series[prefix + "y_m"];
  std::vector<double>& theta = run.series[prefix + "theta_rad"];
  for (const Pose& pose : poses) {
    x.push_back(pose.x);
    y.push_back(pose.y);
    theta.push_back(pose.theta);
  }
}

void put_times(RunRecord& run, const Recording& recording) {
  std::vector<double>& time = run.series["time_s"];
  for (const std::int64_t time_ns : recording.keyframe_times_ns) {
    time.push_back(static_cast<double>(time_ns) * 1e-9);
  }
}

// Errors of an estimate, and the estimate as it was compared. Returns what the alignment applied.
Pose put_accuracy(RunRecord& run, const Recording& recording, const std::vector<Pose>& estimate,
                  const Configuration& configuration) {
  if (!recording.ground_truth || estimate.size() < 2) {
    put_poses(run, "", estimate);
    return {};
  }
  const std::vector<Pose>& truth = *recording.ground_truth;
  const Aligned aligned = align(estimate, truth, configuration.alignment);
  put_poses(run, "", aligned.poses);
  const auto errors = accuracy(estimate, truth, configuration.alignment);
  if (!errors) return aligned.motion_reference_estimate;
  put(run, "mean_position_error_m", errors->mean_position_error_m);
  put(run, "ate_rmse_m", errors->ate_rmse_m);
  put(run, "max_position_error_m", errors->max_position_error_m);
  put(run, "final_position_error_m", errors->final_position_error_m);
  put(run, "heading_rmse_rad", errors->heading_rmse_rad);
  for (const double keyframes : configuration.study.rpe_keyframes) {
    put_relative(run, "rpe_" + std::to_string(static_cast<int>(keyframes)) + "_keyframes",
                 relative_error(estimate, truth, static_cast<std::size_t>(keyframes)));
  }
  for (const double distance_m : configuration.study.rpe_distances_m) {
    put_relative(run, "rpe_" + number_text(distance_m) + "_m",
                 relative_error_over(estimate, truth, distance_m));
  }
  run.series["position_error_m"] = position_errors_m(aligned.poses, truth);
  run.series["heading_error_rad"] = heading_errors_rad(aligned.poses, truth);
  return aligned.motion_reference_estimate;
}

// In the axes that the estimate was compared in.
void put_covariances(RunRecord& run, const std::vector<Eigen::Matrix3d>& covariances,
                     const Pose& alignment) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(alignment.theta).toRotationMatrix();
  const struct {
    const char* name;
    Eigen::Index row;
    Eigen::Index column;
  } entries[] = {{"cov_xx", 0, 0}, {"cov_xy", 0, 1}, {"cov_xt", 0, 2},
                 {"cov_yy", 1, 1}, {"cov_yt", 1, 2}, {"cov_tt", 2, 2}};
  for (const Eigen::Matrix3d& covariance : covariances) {
    const Eigen::Matrix3d turned = transport(turn, covariance);
    for (const auto& entry : entries) {
      run.series[entry.name].push_back(turned(entry.row, entry.column));
    }
  }
}

void put_consistency(RunRecord& run, const Result& result) {
  if (!result.consistency) return;
  put(run, "anees", result.consistency->anees);
  put(run, "position_anees", result.consistency->position_anees);
  put(run, "share_inside_2_sigma", result.consistency->share_inside_2_sigma);
  run.series["pose_nees"] = result.consistency->pose_nees;
  run.series["position_nees"] = result.consistency->position_nees;
}

void put_loops(RunRecord& run, const Recording& recording, const Result& result,
               double min_overlap) {
  put(run, "registrations", static_cast<double>(recording.log.registration_count()));
  if (!recording.frames.empty()) {
    put(run, "registrations_tried", static_cast<double>(recording.registrations_tried));
    put(run, "registrations_left_out", static_cast<double>(recording.registrations_left_out));
  }
  put(run, "loop_closures", static_cast<double>(result.loop_closures));
  put(run, "rejected", static_cast<double>(result.rejected));
  put(run, "lost", static_cast<double>(result.lost));
  put(run, "loops_kept", static_cast<double>(result.loops_kept));
  if (const auto& counts = result.false_loop_counts) {
    put(run, "false_loops", static_cast<double>(counts->false_loops));
    put(run, "false_loops_kept", static_cast<double>(counts->false_loops_kept));
    put(run, "right_loops_lost", static_cast<double>(counts->right_loops_lost));
    std::vector<double>& is_false = run.series["loop_is_false"];
    for (const bool value : recording.is_false_loop) is_false.push_back(value ? 1.0 : 0.0);
  }
  if (!result.replay.loops.empty()) run.series["loop_weight"] = result.replay.loop_weights;
  double nis_sum = 0.0;
  double nis_count = 0.0;
  for (const LoopDecision& loop : result.replay.loops) {
    run.series["loop_from"].push_back(static_cast<double>(loop.from));
    run.series["loop_to"].push_back(static_cast<double>(loop.to));
    run.series["loop_fate"].push_back(static_cast<double>(loop.fate));
    const bool has_nis = loop.nis && std::isfinite(*loop.nis);
    run.series["loop_nis"].push_back(has_nis ? *loop.nis : -1.0);
    if (!has_nis || loop.fate != LoopFate::used) continue;
    nis_sum += *loop.nis;
    nis_count += 1.0;
  }
  if (nis_count > 0.0) put(run, "mean_nis_accepted", nis_sum / nis_count);
  if (const auto truth = true_overlaps(recording)) {
    put(run, "loop_precision", loop_precision(result.replay.loops, *truth));
    put(run, "loop_recall", loop_recall(result.replay.loops, *truth, min_overlap));
  }
}

void put_cost(RunRecord& run, const Recording& recording, const Replay& replay) {
  put(run, "iterations", replay.iterations);
  put_summary(run, "update_ms", replay.update_ms);
  put_summary(run, "add_ms", replay.add_ms);
  put(run, "total_ms", replay.total_ms);
  put(run, "cpu_ms", replay.cpu_ms);
  if (replay.covariances) put(run, "covariance_ms", replay.covariance_ms);
  if (replay.memory_bytes) put(run, "memory_bytes", static_cast<double>(*replay.memory_bytes));
  run.series["update_ms"] = replay.update_ms;
  std::vector<double>& keyframes = run.series["update_keyframe"];
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    if (!recording.log.arrival(k).registrations.empty()) {
      keyframes.push_back(static_cast<double>(k));
    }
  }
}

}  // namespace

std::optional<double> batch_optimum(const MeasurementLog& log, const std::vector<Pose>& estimate,
                                    const EstimatorRegistry& registry) {
  const auto& entries = registry.entries();
  const auto solver = std::find_if(entries.begin(), entries.end(),
                                   [](const EstimatorEntry& entry) { return entry.can_batch; });
  if (solver == entries.end()) return std::nullopt;
  std::optional<double> least;
  const auto solve_from = [&](std::span<const Pose> start) {
    ReplayOptions options;
    options.mode = SolveMode::batch;
    options.start = start;
    options.covariances = false;
    const Replay solved = replay(log, *solver, {}, options);
    if (!is_done(solved.outcome)) return;
    const double cost = chi2(log, solved.trajectory);
    if (std::isfinite(cost) && (!least || cost < *least)) least = cost;
  };
  solve_from({});
  const bool finite = std::all_of(estimate.begin(), estimate.end(),
                                  [](const Pose& pose) { return is_finite(pose); });
  if (finite) solve_from(estimate);
  return least;
}

RunRecord run_record(const Recording& recording, const Result& result,
                     const Configuration& configuration, const EstimatorRegistry& registry) {
  RunRecord run;
  run.outcome = name_of(result.replay.outcome);
  run.fault = result.replay.fault;
  run.log_hash = hash_text(to_g2o(recording.log));
  put(run, "keyframes", static_cast<double>(recording.log.size()));
  put_times(run, recording);
  const Pose alignment = put_accuracy(run, recording, result.replay.trajectory, configuration);
  if (result.replay.covariances) put_covariances(run, *result.replay.covariances, alignment);
  put_consistency(run, result);
  put_loops(run, recording, result, configuration.study.min_overlap);
  put(run, "chi2", result.chi2);
  put(run, "chi2_used", result.replay.cost_used);
  if (const auto optimum = batch_optimum(recording.log, result.replay.trajectory, registry)) {
    put(run, "chi2_optimum", *optimum);
    put(run, "chi2_gap", result.chi2 - *optimum);
  }
  put_cost(run, recording, result.replay);
  return run;
}

RunRecord baseline_record(const Recording& recording, const Configuration& configuration) {
  RunRecord run;
  run.key.estimator = kDeadReckoning;
  put(run, "keyframes", static_cast<double>(recording.log.size()));
  put_times(run, recording);
  put_accuracy(run, recording, recording.log.odometry(), configuration);
  if (recording.ground_truth) put_poses(run, "truth_", *recording.ground_truth);
  return run;
}

}  // namespace fathom
