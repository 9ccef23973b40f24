#include "fathom/harness/run_record.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measured_parts.hpp"
#include "fathom/results/run_series.hpp"

namespace fathom {
namespace {

struct PoseSeries {
  RunSeries<double> x_m;
  RunSeries<double> y_m;
  RunSeries<double> theta_rad;
};

constexpr PoseSeries kEstimate{series::x_m, series::y_m, series::theta_rad};
constexpr PoseSeries kTruth{series::truth_x_m, series::truth_y_m, series::truth_theta_rad};

void put_poses(RunRecord& record, const PoseSeries& to, const std::vector<Pose>& poses) {
  for (const Pose& pose : poses) {
    append(record, to.x_m, pose.x);
    append(record, to.y_m, pose.y);
    append(record, to.theta_rad, pose.theta);
  }
}

void put_times(RunRecord& record, const Recording& recording) {
  put(record, series::time_s, {});
  for (const std::int64_t time_ns : recording.keyframe_times_ns) {
    append(record, series::time_s, static_cast<double>(time_ns) * 1e-9);
  }
}

// The aligned estimate with its errors. Returns what the alignment applied.
Pose put_estimate(RunRecord& record, const Recording& recording, const std::vector<Pose>& estimate,
                  Alignment alignment) {
  if (!recording.ground_truth || !leaves_an_error(estimate.size(), alignment)) {
    put_poses(record, kEstimate, estimate);
    return {};
  }
  const std::vector<Pose>& truth = *recording.ground_truth;
  const Aligned aligned = align(estimate, truth, alignment);
  put_poses(record, kEstimate, aligned.poses);
  if (record.metrics.contains("mean_position_error_m")) {
    put(record, series::position_error_m, position_errors_m(aligned.poses, truth));
    put(record, series::heading_error_rad, heading_errors_rad(aligned.poses, truth));
  }
  return aligned.motion_reference_estimate;
}

// In the axes of the aligned estimate.
void put_covariances(RunRecord& record, const std::vector<Eigen::Matrix3d>& covariances,
                     const Pose& alignment) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(alignment.theta).toRotationMatrix();
  for (const Eigen::Matrix3d& covariance : covariances) {
    const Eigen::Matrix3d turned = transport(turn, covariance);
    append(record, series::cov_xx, turned(0, 0));
    append(record, series::cov_xy, turned(0, 1));
    append(record, series::cov_xt, turned(0, 2));
    append(record, series::cov_yy, turned(1, 1));
    append(record, series::cov_yt, turned(1, 2));
    append(record, series::cov_tt, turned(2, 2));
  }
}

void put_consistency(RunRecord& record, const std::optional<Consistency>& consistency) {
  if (!consistency) return;
  put(record, series::pose_nees, consistency->pose_nees);
  put(record, series::position_nees, consistency->position_nees);
}

void put_loops(RunRecord& record, const Recording& recording, const Run& run) {
  for (const bool is_false : recording.is_false_loop) {
    append(record, series::loop_is_false, is_false);
  }
  if (!run.loops.empty()) put(record, series::loop_weight, run.loop_weights);
  for (const LoopDecision& loop : run.loops) {
    append(record, series::loop_from, loop.from);
    append(record, series::loop_to, loop.to);
    append(record, series::loop_fate, loop.fate);
    append(record, series::loop_nis, loop.nis);
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
      append(record, series::absolute_x_m, at.x());
      append(record, series::absolute_y_m, at.y());
      append(record, series::absolute_cov_xx, C(0, 0));
      append(record, series::absolute_cov_xy, C(0, 1));
      append(record, series::absolute_cov_yy, C(1, 1));
    }
  }
  if (std::ranges::any_of(all, [](const auto& one) { return one.heading_rad.has_value(); })) {
    for (const MeasuredParts& one : all) {
      append(record, series::absolute_theta_rad, one.heading_rad.value_or(kNone));
      append(record, series::absolute_sigma_rad, one.heading_rad ? one.heading_sigma_rad : kNone);
    }
  }
}

void put_absolute(RunRecord& record, const Recording& recording, const Run& run,
                  const Pose& alignment) {
  put_measured(record, recording.log, alignment);
  if (!run.absolute.empty()) put(record, series::absolute_weight, run.absolute_weights);
  for (const AbsoluteDecision& z : run.absolute) {
    append(record, series::absolute_keyframe, z.keyframe);
    append(record, series::absolute_fate, z.fate);
    append(record, series::absolute_nis, z.nis);
  }
}

void put_updates(RunRecord& record, const Recording& recording, const Run& run) {
  put(record, series::update_ms, run.costs.update_ms);
  put(record, series::update_keyframe, {});
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    const KeyframeMeasurements& arrival = recording.log.arrival(k);
    if (!arrival.registrations.empty() || !arrival.absolute.empty()) {
      append(record, series::update_keyframe, k);
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
  if (recording.ground_truth) put_poses(record, kTruth, *recording.ground_truth);
  return record;
}

}  // namespace fathom
