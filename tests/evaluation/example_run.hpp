#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fathom/evaluation/metrics.hpp"

namespace fathom::test {

/// Three keyframes along x, 1 m apart; the last is estimated 0.3 m too far and 0.1 rad off.
struct ExampleRun {
  MeasurementLog log;
  std::vector<Pose> truth{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<Pose> estimate{{0, 0, 0}, {1, 0, 0}, {2.3, 0, 0.1}};
  std::vector<Eigen::Matrix3d> covariances{3, Eigen::Vector3d(0.09, 0.01, 0.01).asDiagonal()};
  /// Of them with two frames between, one of them off by 0.5 m.
  std::vector<Pose> frame_truth{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1.5, 0, 0}, {2, 0, 0}};
  std::vector<Pose> frame_estimate{
      {0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1.5, -0.5, 0}, {2.3, 0, 0.1}};
  Run run;
  std::vector<bool> is_false_loop{false, false, true, true, false};
  // The motion 1-2 is off by (0.3, 0, 0.1), and so is 0-2.
  std::vector<JudgedMotions> motions{
      {MotionsOver::keyframes, 1.0, {{0, 1}, {1, 2}}, {2, 0.01 * Eigen::Matrix3d::Identity()}},
      {MotionsOver::distance_m, 1.5, {{0, 2}}, {0.02 * Eigen::Matrix3d::Identity()}},
      {MotionsOver::anchors, 1.0, {{1, 0}, {1, 2}}, {2, 0.04 * Eigen::Matrix3d::Identity()}}};
  TrueOverlaps overlaps{{{0, 1, 0.6}, {0, 2, 0.4}, {1, 2, 0.1}}};

  ExampleRun() {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    log.add_keyframe(RelativePose::from_covariance(0, 1, {1, 0, 0}, one));
    log.add_keyframe(RelativePose::from_covariance(1, 2, {1, 0, 0}, one));
    log.add_registration(RelativePose::from_covariance(0, 2, {2, 0, 0}, one));
    run.loops = {{0, 2, LoopFate::used, 2.0},
                 {2, 0, LoopFate::used, 4.0},
                 {1, 2, LoopFate::used, std::nullopt},
                 {1, 0, LoopFate::rejected, 50.0},
                 {0, 1, LoopFate::lost, std::nullopt}};
    run.loop_weights = {0.9, 0.2, 0.8, 0.0, 0.0};
    run.chi2_initial = 9.0;
    run.chi2_used = 0.25;
    run.iterations = 7;
    run.is_local_minimum = true;
    run.costs.update_ms = {4.0, 1.0, 3.0};
    run.costs.add_ms = {0.5, 1.5};
    run.costs.newest_covariance_ms = {0.25, 0.75};
    run.costs.candidate_covariance_ms = 2.5;
    run.costs.total_ms = 10.0;
    run.costs.cpu_ms = 9.5;
    run.costs.memory_bytes = 4096;
  }

  RunFacts facts() const {
    RunFacts facts{.log = log,
                   .registrations_tried = 11,
                   .registrations_left_out = 2,
                   .ground_truth = truth,
                   .frame_estimate = frame_estimate,
                   .frame_ground_truth = frame_truth,
                   .true_overlaps = &overlaps,
                   .chi2_optimum = 0.125,
                   .estimate = estimate,
                   .covariances = covariances,
                   .motions = motions,
                   .run = &run,
                   .is_false_loop = &is_false_loop,
                   .options = {}};
    facts.options.rpe_keyframes = {1, 2, 5};
    facts.options.rpe_distances_m = {1.5};
    return facts;
  }
};

inline std::map<std::string, double> values_of(const RunFacts& facts) {
  return metric_values(judge(facts));
}

}  // namespace fathom::test
