#include "fathom/harness/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measured_parts.hpp"

namespace fathom {
namespace {

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

// The aligned estimate with its errors. Returns what the alignment applied.
Pose put_estimate(RunRecord& run, const Recording& recording, const std::vector<Pose>& estimate,
                  Alignment alignment) {
  if (!recording.ground_truth || !leaves_an_error(estimate.size(), alignment)) {
    put_poses(run, "", estimate);
    return {};
  }
  const std::vector<Pose>& truth = *recording.ground_truth;
  const Aligned aligned = align(estimate, truth, alignment);
  put_poses(run, "", aligned.poses);
  if (run.metrics.contains("mean_position_error_m")) {
    run.series["position_error_m"] = position_errors_m(aligned.poses, truth);
    run.series["heading_error_rad"] = heading_errors_rad(aligned.poses, truth);
  }
  return aligned.motion_reference_estimate;
}

// In the axes of the aligned estimate.
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

void put_consistency(RunRecord& run, const std::optional<Consistency>& consistency) {
  if (!consistency) return;
  run.series["pose_nees"] = consistency->pose_nees;
  run.series["position_nees"] = consistency->position_nees;
}

void put_loops(RunRecord& run, const Recording& recording, const Replay& replay) {
  for (const bool is_false : recording.is_false_loop) {
    run.series["loop_is_false"].push_back(is_false ? 1.0 : 0.0);
  }
  if (!replay.loops.empty()) run.series["loop_weight"] = replay.loop_weights;
  for (const LoopDecision& loop : replay.loops) {
    run.series["loop_from"].push_back(static_cast<double>(loop.from));
    run.series["loop_to"].push_back(static_cast<double>(loop.to));
    run.series["loop_fate"].push_back(static_cast<double>(loop.fate));
    const bool has_nis = loop.nis && std::isfinite(*loop.nis);
    run.series["loop_nis"].push_back(has_nis ? *loop.nis : -1.0);
  }
}

// What was measured, in the frame of the aligned estimate. NaN: nothing of that kind; where no
// measurement has it, the series is absent.
void put_measured(RunRecord& run, const MeasurementLog& log, const Pose& alignment) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<MeasuredParts> all;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      all.push_back(parts_of(moved(z, alignment)));
    }
  }
  if (std::ranges::any_of(all, [](const MeasuredParts& one) { return one.position.has_value(); })) {
    for (const MeasuredParts& one : all) {
      const Eigen::Vector2d at = one.position.value_or(Eigen::Vector2d::Constant(kNone));
      const Eigen::Matrix2d C =
          one.position ? one.position_covariance : Eigen::Matrix2d::Constant(kNone);
      run.series["absolute_x_m"].push_back(at.x());
      run.series["absolute_y_m"].push_back(at.y());
      run.series["absolute_cov_xx"].push_back(C(0, 0));
      run.series["absolute_cov_xy"].push_back(C(0, 1));
      run.series["absolute_cov_yy"].push_back(C(1, 1));
    }
  }
  if (std::ranges::any_of(all, [](const auto& one) { return one.heading_rad.has_value(); })) {
    for (const MeasuredParts& one : all) {
      run.series["absolute_theta_rad"].push_back(one.heading_rad.value_or(kNone));
      run.series["absolute_sigma_rad"].push_back(one.heading_rad ? one.heading_sigma_rad : kNone);
    }
  }
}

void put_absolute(RunRecord& run, const Recording& recording, const Replay& replay,
                  const Pose& alignment) {
  put_measured(run, recording.log, alignment);
  if (!replay.absolute.empty()) run.series["absolute_weight"] = replay.absolute_weights;
  for (const AbsoluteDecision& z : replay.absolute) {
    run.series["absolute_keyframe"].push_back(static_cast<double>(z.keyframe));
    run.series["absolute_fate"].push_back(static_cast<double>(z.fate));
    const bool has_nis = z.nis && std::isfinite(*z.nis);
    run.series["absolute_nis"].push_back(has_nis ? *z.nis : -1.0);
  }
}

void put_updates(RunRecord& run, const Recording& recording, const Replay& replay) {
  run.series["update_ms"] = replay.update_ms;
  std::vector<double>& keyframes = run.series["update_keyframe"];
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    const KeyframeMeasurements& arrival = recording.log.arrival(k);
    if (!arrival.registrations.empty() || !arrival.absolute.empty()) {
      keyframes.push_back(static_cast<double>(k));
    }
  }
}

}  // namespace

RunRecord run_record(const Recording& recording, const Result& result,
                     const std::string& log_hash) {
  RunRecord run;
  run.outcome = name_of(result.replay.outcome);
  run.fault = result.replay.fault;
  run.log_hash = log_hash;
  run.metrics = result.metrics;
  put_times(run, recording);
  const Pose alignment =
      put_estimate(run, recording, result.replay.trajectory, result.options.alignment);
  if (result.replay.covariances) put_covariances(run, *result.replay.covariances, alignment);
  put_consistency(run, result.consistency);
  put_loops(run, recording, result.replay);
  put_absolute(run, recording, result.replay, alignment);
  put_updates(run, recording, result.replay);
  return run;
}

RunRecord baseline_record(const Recording& recording, const MetricOptions& options) {
  RunRecord run;
  run.key.estimator = kDeadReckoning;
  DeadReckoning judged = judged_dead_reckoning(recording, options);
  run.metrics = std::move(judged.metrics);
  put_times(run, recording);
  const Pose alignment = put_estimate(run, recording, recording.log.odometry(), options.alignment);
  put_covariances(run, judged.covariances, alignment);
  put_consistency(run, judged.consistency);
  if (recording.ground_truth) put_poses(run, "truth_", *recording.ground_truth);
  return run;
}

}  // namespace fathom
