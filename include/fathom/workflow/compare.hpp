#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/results/shard.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// A study: a data set, several estimators, surveys, many trials, perhaps a sweep.
struct CompareRequest {
  Settings settings;
  /// What was read to make these: no output may replace one (inputs_of).
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path out;  ///< a folder, which may have a part of the study
  std::string title;          ///< of the pictures, where the study has none
  std::string made_by;        ///< the command line, for the manifests
  bool mosaics = true;
  RegistrationStore* registrations = nullptr;  ///< may be null: all are made
  /// Set by somebody else to end the study; what is stored stays.
  const std::atomic<bool>* stop = nullptr;
  std::optional<Shard> shard;     ///< the part that is done; all of it if not given
  std::filesystem::path scratch;  ///< of a shard: where its store is made
};

struct CompareOutcome {
  bool is_finished = false;  ///< false where it was stopped before the end
  std::size_t runs = 0;      ///< of estimators that are stored; of a finished shard its own
  /// Whether each estimator has a run that can be used.
  bool all_usable = false;
  std::vector<ExampleRun> example;  ///< as in StudyRun
  std::string table;                ///< of a whole study, for the terminal
};

/// A study that is settled: configured, its data read, the reference of its loop candidates known.
/// Throws InputError.
Study settled_study(const Settings& settings, const EstimatorRegistry& registry);

/// Runs what of a study is not yet in its folder, and writes the folder (docs/outputs.md): of a
/// shard its store alone, and the example where it is its own. Throws InputError.
CompareOutcome compare(const CompareRequest& request, const EstimatorRegistry& registry,
                       const Machine& machine, Observer& observer);

/// Registers the pictures that a study or a shard of it needs, and runs nothing. False where it was
/// stopped before the end. Throws InputError where they cannot be kept.
bool register_study(const CompareRequest& request, const EstimatorRegistry& registry,
                    const Machine& machine, Observer& observer);

}  // namespace fathom::workflow
