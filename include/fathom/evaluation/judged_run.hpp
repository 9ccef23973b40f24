#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/loop_truth.hpp"
#include "fathom/evaluation/relative_consistency.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// The parameters of the metrics.
struct MetricOptions {
  Alignment alignment = Alignment::origin;  ///< of the absolute errors
  std::vector<double> rpe_keyframes{1};     ///< separations of relative errors, whole numbers
  std::vector<double> rpe_distances_m;      ///< and path lengths
  std::size_t anchors = 5;                  ///< keyframes held in turn (anchored_anees)
  std::size_t relative_pairs = 20;          ///< motions over each separation or distance, at most
  double min_overlap = 0.3;  ///< true overlap from which on a pair should be a loop (loop_recall)
};

/// One absolute measurement of the log, with an estimator's decision on it.
struct JudgedAbsolute {
  std::size_t keyframe = 0;
  LoopUse use = LoopUse::used;
  std::optional<double> nis;  ///< as of JudgedLoop, of `rank` degrees of freedom
  int rank = 0;               ///< of its information
  double weight = 1.0;        ///< as of JudgedLoop

  bool is_kept() const { return weight > 0.5; }
};

/// What an estimator did with a log, and what it cost.
struct ReplayFacts {
  std::vector<JudgedLoop> loops;         ///< in the order of the log's registrations
  std::vector<JudgedAbsolute> absolute;  ///< in the order of the log's absolute measurements
  double chi2_initial = 0.0;             ///< F at the initial guess: dead reckoning, or the file's
  double chi2_used = 0.0;                ///< Σ ρ(eᵀ Ω e) over what it used
  double absolute_chi2_used = 0.0;       ///< of it, absolute measurements and an uncertain start
  int iterations = 0;
  std::optional<double> gradient_norm;
  std::optional<bool> is_local_minimum;
  std::span<const double> update_ms;  ///< per update
  std::span<const double> add_ms;     ///< per keyframe
  /// Per keyframe from 1 on: the covariance of its pose, asked for after its update; empty where it
  /// was not.
  std::span<const double> newest_covariance_ms;
  /// Of the covariances that the selection of loop candidates asks for, a part of total_ms.
  std::optional<double> candidate_covariance_ms;
  double total_ms = 0.0;
  double cpu_ms = 0.0;
  std::optional<double> covariance_ms;
  std::optional<double> start_up_ms;  ///< of programs that do the work
  std::optional<std::int64_t> memory_bytes;
};

/// All that metrics are computed from: a recording, and what an estimator made of it. What is not
/// known is absent. Lists belong to the caller and outlive this.
struct RunFacts {
  const MeasurementLog& log;
  std::optional<std::size_t> registrations_tried = std::nullopt;     ///< absent of a pose graph
  std::optional<std::size_t> registrations_left_out = std::nullopt;  ///< likewise
  std::optional<std::span<const Pose>> ground_truth = std::nullopt;  ///< of the keyframes
  const TrueOverlaps* true_overlaps = nullptr;
  /// F at the batch optimum of the log: the least that a batch solve reaches.
  std::optional<double> chi2_optimum = std::nullopt;
  std::span<const Pose> estimate = {};
  std::optional<std::span<const Eigen::Matrix3d>> covariances = std::nullopt;  ///< of the estimate
  std::span<const JudgedMotions> motions = {};                                 ///< of the estimate
  /// Absent of dead reckoning, which is no estimator.
  std::optional<ReplayFacts> replay = std::nullopt;
  MetricOptions options = {};
};

/// A run evaluated: the errors and the consistency that several metrics and series share, computed
/// once.
struct JudgedRun {
  RunFacts facts;
  std::optional<Accuracy> accuracy;  ///< with ground truth alone
  std::optional<Consistency> consistency;
};

JudgedRun judge(RunFacts facts);

}  // namespace fathom
