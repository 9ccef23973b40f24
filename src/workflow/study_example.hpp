#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// Where the example of a study goes, and what is said of it.
struct ExamplePlace {
  std::filesystem::path folder;
  std::string title;
  std::string made_by;                    ///< the command line, for the manifests
  const FrameSource* pictures = nullptr;  ///< of mosaics; null: there are none
  std::vector<std::string> remarks;       ///< what looks wrong with it, for the manifests
};

/// Writes the example of a study: a folder an estimator as `run` writes it, `trajectories.png`,
/// `metrics.json`, and what they share.
void write_example(const ExamplePlace& place, const Study& study,
                   const std::vector<ExampleRun>& example, const EstimatorRegistry& registry,
                   Observer& observer);

}  // namespace fathom::workflow
