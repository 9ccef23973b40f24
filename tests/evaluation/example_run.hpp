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
  std::vector<double> update_ms{4.0, 1.0, 3.0};
  std::vector<double> add_ms{0.5, 1.5};
  std::vector<double> newest_covariance_ms{0.25, 0.75};
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
  }

  RunFacts facts() const {
    ReplayFacts replay;
    replay.loops = {{0, 2, LoopUse::used, 2.0, 0.9, false},
                    {2, 0, LoopUse::used, 4.0, 0.2, false},
                    {1, 2, LoopUse::used, std::nullopt, 0.8, true},
                    {1, 0, LoopUse::rejected, 50.0, 0.0, true},
                    {0, 1, LoopUse::lost, std::nullopt, 0.0, false}};
    replay.chi2_initial = 9.0;
    replay.chi2_used = 0.25;
    replay.iterations = 7;
    replay.is_local_minimum = true;
    replay.update_ms = update_ms;
    replay.add_ms = add_ms;
    replay.newest_covariance_ms = newest_covariance_ms;
    replay.candidate_covariance_ms = 2.5;
    replay.total_ms = 10.0;
    replay.cpu_ms = 9.5;
    replay.memory_bytes = 4096;
    RunFacts facts{.log = log,
                   .registrations_tried = 11,
                   .registrations_left_out = 2,
                   .ground_truth = truth,
                   .true_overlaps = &overlaps,
                   .chi2_optimum = 0.125,
                   .estimate = estimate,
                   .covariances = covariances,
                   .motions = motions,
                   .replay = std::move(replay),
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
