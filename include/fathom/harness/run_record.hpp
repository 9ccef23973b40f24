#pragma once

#include "fathom/configuration/configuration.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// What a study keeps of one estimator's run: its metrics and series (docs/formats.md). `key` and
/// `jobs` are for the caller to fill in.
RunRecord run_record(const Recording& recording, const Result& result);

/// What a study keeps of dead reckoning, the baseline, and with it of the ground truth.
RunRecord baseline_record(const Recording& recording, const MetricOptions& options);

/// From ground truth, altitudes and camera; nothing where one of them is not known.
std::optional<TrueOverlaps> true_overlaps(const Recording& recording);

/// The least F that a batch solve of the log reaches, from dead reckoning and from this estimate:
/// the best optimum that is known. Solved by the first estimator of the registry that can solve a
/// batch; nothing without one, or where it fails from both starts.
std::optional<double> batch_optimum(const MeasurementLog& log, const std::vector<Pose>& estimate,
                                    const EstimatorRegistry& registry);

}  // namespace fathom
