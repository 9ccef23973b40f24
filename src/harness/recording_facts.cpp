#include "fathom/harness/recording_facts.hpp"

#include <cmath>

#include "fathom/core/hash.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/measurements/shared_file.hpp"

namespace fathom {

std::optional<BatchOptimum> batch_optimum(const MeasurementLog& log,
                                          const EstimatorRegistry& registry,
                                          std::span<const Pose> start) {
  std::optional<BatchOptimum> best;
  for (const EstimatorEntry& entry : registry.entries()) {
    if (!entry.can_batch || entry.runs_program) continue;
    ReplayOptions options;
    options.mode = SolveMode::batch;
    options.start = start;
    options.covariances = false;
    Run solved = replay(log, entry, {}, options);
    if (!is_done(solved.outcome)) continue;
    const double cost = chi2(log, solved.trajectory);
    if (!std::isfinite(cost) || (best && cost >= best->chi2)) continue;
    best = BatchOptimum{std::move(solved.trajectory), cost, entry.name};
  }
  return best;
}

RecordingFacts run_facts(const Recording& recording) {
  return {true_overlaps(recording), std::nullopt, ""};
}

RecordingFacts study_facts(const Recording& recording, const EstimatorRegistry& registry) {
  RecordingFacts facts = run_facts(recording);
  if (const auto optimum = batch_optimum(recording.log, registry)) {
    facts.chi2_optimum = optimum->chi2;
  }
  facts.log_hash = hash_text(text_of(recording.log));
  return facts;
}

}  // namespace fathom
