#include "fathom/harness/run_record.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measured_parts.hpp"

namespace fathom {
namespace {

void put_poses(RunRecord& record, const std::string& prefix, const std::vector<Pose>& poses) {
  std::vector<double>& x = record.series[prefix + "x_m"];
  std::vector<double>& y = record.series[prefix + "y_m"];
  std::vector<double>& theta = record.series[prefix + "theta_rad"];
  for (const Pose& pose : poses) {
    x.push_back(pose.x);
    y.push_back(pose.y);
    theta.push_back(pose.theta);
  }
}

void put_times(RunRecord& record, const Recording& recording) {
  std::vector<double>& time = record.series["time_s"];
  for (const std::int64_t time_ns : recording.keyframe_times_ns) {
    time.push_back(static_cast<double>(time_ns) * 1e-9);
  }
}

// The aligned estimate with its errors. Returns what the alignment applied.
Pose put_estimate(RunRecord& record, const Recording& recording, const std::vector<Pose>& estimate,
                  Alignment alignment) {
  if (!recording.ground_truth || !leaves_an_error(estimate.size(), alignment)) {
    put_poses(record, "", estimate);
    return {};
  }
  const std::vector<Pose>& truth = *recording.ground_truth;
  const Aligned aligned = align(estimate, truth, alignment);
  put_poses(record, "", aligned.poses);
  if (record.metrics.contains("mean_position_error_m")) {
    record.series["position_error_m"] = position_errors_m(aligned.poses, truth);
    record.series["heading_error_rad"] = heading_errors_rad(aligned.poses, truth);
  }
  return aligned.motion_reference_estimate;
}

// In the axes of the aligned estimate.
void put_covariances(RunRecord& record, const std::vector<Eigen::Matrix3d>& covariances,
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
      record.series[entry.name].push_back(turned(entry.row, entry.column));
    }
  }
}

void put_consistency(RunRecord& record, const std::optional<Consistency>& consistency) {
  if (!consistency) return;
  record.series["pose_nees"] = consistency->pose_nees;
  record.series["position_nees"] = consistency->position_nees;
}

void put_loops(RunRecord& record, const Recording& recording, const Run& run) {
  for (const bool is_false : recording.is_false_loop) {
    record.series["loop_is_false"].push_back(is_false ? 1.0 : 0.0);
  }
  if (!run.loops.empty()) record.series["loop_weight"] = run.loop_weights;
  for (const LoopDecision& loop : run.loops) {
    record.series["loop_from"].push_back(static_cast<double>(loop.from));
    record.series["loop_to"].push_back(static_cast<double>(loop.to));
    record.series["loop_fate"].push_back(static_cast<double>(loop.fate));
    record.series["loop_nis"].push_back(loop.nis.value_or(-1.0));
  }
}

// What was measured, in the frame of the aligned estimate. NaN: nothing of that kind; where no
// measurement has it, the series is absent.
void put_measured(RunRecord& record, const MeasurementLog& log, const Pose& alignment) {
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
      record.series["absolute_x_m"].push_back(at.x());
      record.series["absolute_y_m"].push_back(at.y());
      record.series["absolute_cov_xx"].push_back(C(0, 0));
      record.series["absolute_cov_xy"].push_back(C(0, 1));
      record.series["absolute_cov_yy"].push_back(C(1, 1));
    }
  }
  if (std::ranges::any_of(all, [](const auto& one) { return one.heading_rad.has_value(); })) {
    for (const MeasuredParts& one : all) {
      record.series["absolute_theta_rad"].push_back(one.heading_rad.value_or(kNone));
      record.series["absolute_sigma_rad"].push_back(one.heading_rad ? one.heading_sigma_rad
                                                                    : kNone);
    }
  }
}

void put_absolute(RunRecord& record, const Recording& recording, const Run& run,
                  const Pose& alignment) {
  put_measured(record, recording.log, alignment);
  if (!run.absolute.empty()) record.series["absolute_weight"] = run.absolute_weights;
  for (const AbsoluteDecision& z : run.absolute) {
    record.series["absolute_keyframe"].push_back(static_cast<double>(z.keyframe));
    record.series["absolute_fate"].push_back(static_cast<double>(z.fate));
    record.series["absolute_nis"].push_back(z.nis.value_or(-1.0));
  }
}

void put_updates(RunRecord& record, const Recording& recording, const Run& run) {
  record.series["update_ms"] = run.costs.update_ms;
  std::vector<double>& keyframes = record.series["update_keyframe"];
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
  RunRecord record;
  record.outcome = name_of(result.run.outcome);
  record.fault = result.run.fault;
  record.log_hash = log_hash;
  record.metrics = result.metrics;
  put_times(record, recording);
  const Pose alignment =
      put_estimate(record, recording, result.run.trajectory, result.options.alignment);
  if (result.run.covariances) put_covariances(record, *result.run.covariances, alignment);
  put_consistency(record, result.consistency);
  put_loops(record, recording, result.run);
  put_absolute(record, recording, result.run, alignment);
  put_updates(record, recording, result.run);
  return record;
}

RunRecord baseline_record(const Recording& recording, const MetricOptions& options) {
  RunRecord record;
  record.key.estimator = kDeadReckoning;
  DeadReckoning judged = judged_dead_reckoning(recording, options);
  record.metrics = std::move(judged.metrics);
  put_times(record, recording);
  const Pose alignment =
      put_estimate(record, recording, recording.log.odometry(), options.alignment);
  put_covariances(record, judged.covariances, alignment);
  put_consistency(record, judged.consistency);
  if (recording.ground_truth) put_poses(record, "truth_", *recording.ground_truth);
  return record;
}

}  // namespace fathom
