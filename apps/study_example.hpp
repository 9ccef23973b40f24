#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/study_run.hpp"

namespace fathom {

/// Writes the example of a study: a folder an estimator as `run` writes it, `trajectories.png`,
/// `metrics.json`, and what they share. `registry` has its estimators, and `command_line` is for
/// the manifests. Mosaics of `pictures`, where given.
void write_example(const std::filesystem::path& out, const Study& study,
                   const std::vector<ExampleRun>& example, const std::string& title,
                   const FrameSource* pictures, bool quiet, const EstimatorRegistry& registry,
                   const std::string& command_line);

}  // namespace fathom
