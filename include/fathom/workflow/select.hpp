#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fathom/results/selection.hpp"
#include "fathom/workflow/named_code.hpp"

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
  NamedCode named;               ///< in selected.yaml, so that `run` executes it
};

/// Names the back end that meets requirements, from the runs of a study, and writes a configuration
/// of it for `run`. Plug-ins that the study names are not loaded. Throws InputError.
SelectOutcome select(const SelectRequest& request, const EstimatorRegistry& registry);

/// Without a study: which back end suits a pose graph, the log in a run's folder, or a survey in
/// the EuRoC/ASL layout, a line (Advice). Nothing where the path is none of these, as a study's
/// folder and its results are. Throws InputError.
std::optional<std::string> advice_for(const std::filesystem::path& path);

}  // namespace fathom::workflow
