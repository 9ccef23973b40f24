#pragma once

#include <filesystem>
#include <string>

#include "fathom/results/selection.hpp"
#include "fathom/workflow/known_estimators.hpp"

namespace fathom::workflow {

struct SelectRequest {
  std::filesystem::path results;  ///< folder of a study, or its results.sqlite
  SelectionQuery query;
  std::filesystem::path out;  ///< folder of selected.yaml; empty: that of the results
};

struct SelectOutcome {
  Selection selection;
  std::filesystem::path config;  ///< selected.yaml; empty where none meets
  std::string text;              ///< selection_text
};

/// Names the back end that meets requirements, from the runs of a study, and writes a configuration
/// of it for `run`. Plug-ins that the study names are loaded where they have to be known. Throws
/// InputError.
SelectOutcome select(const SelectRequest& request, KnownEstimators& estimators);

}  // namespace fathom::workflow
