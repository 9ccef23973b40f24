#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fathom/datasets/data_set.hpp"
#include "fathom/evaluation/held_out.hpp"
#include "fathom/evaluation/keyframe_pairs.hpp"
#include "fathom/evaluation/metric_options.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/replay.hpp"

namespace fathom {

/// Draws which loops of a trial's recording are held out of second runs; none where their share
/// is 0.
void hold_out(Recording& recording, const MetricOptions& options, const TrialNoise& noise);

/// Those of a recording, still without an estimate; nothing where there is no second run.
std::optional<HeldOutLoops> held_out_loops(const Recording& recording,
                                           const MetricOptions& options);

/// The keyframes of those that are tested.
std::vector<KeyframePair> tested_pairs(const HeldOutLoops& held_out);

/// How an estimator is given a log.
using ReplayOfLog = std::function<Run(const MeasurementLog& log, const ReplayOptions& options)>;

/// The second run: the log without the held-out loops, with no cost measured. `options` are those
/// of the first one. Nothing where there is none or it fails.
std::optional<HeldOutLoops> held_out_run(const Recording& recording, const MetricOptions& metrics,
                                         const ReplayOptions& options, const ReplayOfLog& replay);

}  // namespace fathom
