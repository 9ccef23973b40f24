#include "fathom/harness/recording_facts.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/hash.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/measurements/shared_file.hpp"

namespace fathom {

namespace {

// Its default options, but for which F it minimises, where the log lets it choose.
EstimatorValues values_for(const EstimatorEntry& entry, const MeasurementLog& log,
                           RegistrationErrors errors) {
  constexpr const char* kKey = "shared_errors";
  const bool chooses = log.tells_shared_errors() &&
                       std::ranges::any_of(entry.options, [](const OptionDescription& option) {
                         return option.key == kKey;
                       });
  if (!chooses) return {};
  const bool is_shared = errors == RegistrationErrors::shared;
  return {{kKey, OptionValue::scalar(is_shared ? "states" : "independent")}};
}

}  // namespace

std::optional<BatchOptimum> batch_optimum(const MeasurementLog& log,
                                          const EstimatorRegistry& registry,
                                          std::span<const Pose> start, RegistrationErrors errors) {
  std::optional<BatchOptimum> best;
  for (const EstimatorEntry& entry : registry.entries()) {
    if (!entry.can_batch || entry.runs_program) continue;
    ReplayOptions options;
    options.mode = SolveMode::batch;
    options.start = start;
    options.covariances = false;
    const EstimatorValues values = values_for(entry, log, errors);
    Run solved = replay(log, entry, values, options);
    if (!is_done(solved.outcome)) continue;
    const double cost = chi2(log, solved.trajectory, errors);
    if (!std::isfinite(cost) || (best && cost >= best->chi2)) continue;
    best = BatchOptimum{std::move(solved.trajectory), cost, entry.name, values, errors};
  }
  return best;
}

RecordingFacts run_facts(const Recording& recording) {
  return {true_overlaps(recording), std::nullopt, std::nullopt, std::nullopt, ""};
}

RecordingFacts study_facts(const Recording& recording, const EstimatorRegistry& registry) {
  RecordingFacts facts = run_facts(recording);
  if (const auto optimum = batch_optimum(recording.log, registry)) {
    facts.chi2_optimum = optimum->chi2;
  }
  if (recording.log.tells_shared_errors()) {
    const auto optimum = batch_optimum(recording.log, registry, {}, RegistrationErrors::shared);
    if (optimum) facts.shared_chi2_optimum = optimum->chi2;
  }
  facts.loop_terms = loop_terms(recording.log);
  facts.log_hash = hash_text(text_of(recording.log));
  return facts;
}

}  // namespace fathom
