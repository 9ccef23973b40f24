#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/measurements/graph_check.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// What is in a pose graph, and what looks wrong with it.
struct GraphCheck {
  GraphSummary graph;                ///< where it has faults, the rest is not known
  std::optional<double> guess_chi2;  ///< F at the poses that the file gives
  double start_chi2 = 0.0;           ///< F at what a batch solve starts from
  bool starts_from_odometry = true;
  std::optional<double> batch_chi2;  ///< F where a batch solve ends, if that tells of the scale
  std::optional<InformationScale> scale;
  std::string advice;  ///< which back end suits it, a line
  std::vector<std::string> warnings;
};

/// What `run` and `solve` refuse is a fault, or thrown as InputError.
GraphCheck check_graph(const std::filesystem::path& path, const EstimatorRegistry& registry,
                       const GraphOptions& options = {});

/// What is in an image folder, and what a run will find.
struct SurveyCheck {
  FolderSummary folder;               ///< where it has faults, the rest is not known
  std::vector<std::string> expected;  ///< what the front end will find, in words
  std::string advice;                 ///< which back end suits it, a line; empty: not known
};

/// `settings`: settings_of(path), and what is to be held instead of its values. Registers pairs of
/// near pictures (calibrate), whose progress the observer hears; kept in `registrations`, which may
/// be null. Throws InputError, also of plain pictures where the settings do not say what they do
/// not.
SurveyCheck check_survey(const std::filesystem::path& path, const Settings& settings,
                         const EstimatorRegistry& registry, RegistrationCache* registrations,
                         Observer& observer);

}  // namespace fathom::workflow
