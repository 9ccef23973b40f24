#pragma once

#include "fathom/configuration/configuration.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// What a study keeps of one estimator's run: its metrics and series (docs/formats.md). `key` and
/// `jobs` are for the caller to fill in.
RunRecord run_record(const Recording& recording, const Result& result,
                     const Configuration& configuration, const EstimatorRegistry& registry);

/// What a study keeps of dead reckoning, the baseline, and with it of the ground truth.
RunRecord baseline_record(const Recording& recording, const Configuration& configuration);

/// Pairs of keyframes that truly overlap: what loop closing could find at best, and what a loop
/// must be to be right.
struct TrueOverlaps {
  struct Pair {
    std::size_t i = 0;
    std::size_t k = 0;
    double overlap = 0.0;  ///< 0 to 1
  };
  /// Those that overlap at all, i < k, by rising i and k: of a long survey a small part of all.
  std::vector<Pair> pairs;

  /// Of keyframes i < k.
  double of(std::size_t i, std::size_t k) const;
};

/// From ground truth, altitudes and camera; nothing where one of them is not known.
std::optional<TrueOverlaps> true_overlaps(const Recording& recording);

/// Share of the accepted loops whose pictures overlap at all; nothing without a loop.
std::optional<double> loop_precision(const std::vector<LoopDecision>& loops,
                                     const TrueOverlaps& truth);

/// Share of the pairs that overlap by `min_overlap` or more that are accepted loops; nothing where
/// there is no such pair.
std::optional<double> loop_recall(const std::vector<LoopDecision>& loops, const TrueOverlaps& truth,
                                  double min_overlap);

/// The least F that a batch solve of the log reaches, from dead reckoning and from this estimate:
/// the best optimum that is known. Solved by the first estimator of the registry that can solve a
/// batch; nothing without one, or where it fails from both starts.
std::optional<double> batch_optimum(const MeasurementLog& log, const std::vector<Pose>& estimate,
                                    const EstimatorRegistry& registry);

}  // namespace fathom
