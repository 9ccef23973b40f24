#pragma once

#include <string>

#include "fathom/configuration/configuration.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// What a study stores of one estimator's run: its metrics and series (docs/outputs.md). `key` and
/// `jobs` are for the caller to fill in.
RunRecord run_record(const Recording& recording, const Result& result, const std::string& log_hash);

/// What a study stores of dead reckoning, the baseline, and of the ground truth.
RunRecord baseline_record(const Recording& recording, const MetricOptions& options);

}  // namespace fathom
