#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/held_out.hpp"
#include "fathom/evaluation/loop_truth.hpp"
#include "fathom/evaluation/metric_options.hpp"
#include "fathom/evaluation/relative_consistency.hpp"
#include "fathom/evaluation/run.hpp"
#include "fathom/measurements/loop_terms.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// All that metrics are computed from: a recording, and what an estimator made of it. What is not
/// known is absent. Lists belong to the caller and outlive this.
struct RunFacts {
  const MeasurementLog& log;
  std::optional<std::size_t> registrations_tried = std::nullopt;     ///< absent of a pose graph
  std::optional<std::size_t> registrations_left_out = std::nullopt;  ///< likewise
  std::optional<std::span<const Pose>> ground_truth = std::nullopt;  ///< of the keyframes
  /// Of the frames that have ground truth, where all keyframes have it; else empty.
  std::span<const Pose> frame_estimate = {};
  std::span<const Pose> frame_ground_truth = {};
  const TrueOverlaps* true_overlaps = nullptr;
  /// F at the batch optimum of the log: the least that a batch solve reaches.
  std::optional<double> chi2_optimum = std::nullopt;
  const LoopTerms* loop_terms = nullptr;  ///< of the log; null: not computed
  std::span<const Pose> estimate = {};
  std::optional<std::span<const Eigen::Matrix3d>> covariances = std::nullopt;  ///< of the estimate
  std::span<const JudgedMotions> motions = {};                                 ///< of the estimate
  /// What the estimator did and what it cost; null of dead reckoning, which is no estimator.
  const Run* run = nullptr;
  /// Of each registration, whether it is false; null where that is not known.
  const std::vector<bool>* is_false_loop = nullptr;
  /// Of a second run; null where there was none, or it failed.
  const HeldOutLoops* held_out = nullptr;
  MetricOptions options = {};
};

/// A run evaluated: the errors and the consistency that several metrics and series share, computed
/// once.
struct JudgedRun {
  RunFacts facts;
  std::optional<Accuracy> accuracy;  ///< with ground truth alone
  std::optional<Consistency> consistency;
  std::optional<Accuracy> frame_accuracy;  ///< of the frames
  std::optional<HeldOutErrors> held_out;   ///< with held-out loops alone
};

JudgedRun judge(RunFacts facts);

}  // namespace fathom
