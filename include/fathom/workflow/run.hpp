#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// A data set, one estimator.
struct RunRequest {
  Settings settings;
  /// What was read to make these: no output may replace one (inputs_of).
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path out;  ///< a folder; empty: nothing is written
  std::string title;          ///< of the pictures
  std::string made_by;        ///< the command line, for run.json
  bool mosaics = true;
  RegistrationCache* registrations = nullptr;  ///< may be null: all are made
};

struct RunOutcome {
  std::shared_ptr<const Recording> recording;
  Result result;
  /// The batch optimum of the log, where the estimate does not fit it.
  std::optional<Result> optimum;
  Alignment alignment = Alignment::origin;  ///< of the errors
};

/// Records the data set, gives the log to the estimator, judges it, and writes the folder of the
/// run (docs/outputs.md). Remarks are also in run.json. Throws InputError.
RunOutcome run(const RunRequest& request, const EstimatorRegistry& registry, const Machine& machine,
               Observer& observer);

}  // namespace fathom::workflow
