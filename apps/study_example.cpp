#include "apps/study_example.hpp"

#include <cstdio>

#include "apps/map_files.hpp"
#include "apps/mosaics.hpp"
#include "apps/pictures.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/run_folder.hpp"

namespace fathom {

namespace fs = std::filesystem;

void write_example(const fs::path& out, const Study& study, const std::vector<ExampleRun>& example,
                   const std::string& title, const FrameSource* pictures, bool quiet,
                   const EstimatorRegistry& registry, const std::string& command_line) {
  const Configuration& configuration = study.cells.front();
  StagedFolder folder(out);
  const EarthOrWhyNot earth = earth_or_why_not(configuration);
  if (!earth.why_not.empty() && !quiet) std::printf("warning: %s\n", earth.why_not.c_str());
  const EarthFrame* on_earth = earth.frame ? &*earth.frame : nullptr;
  std::vector<Result> results;
  std::vector<RunMosaic> mosaics;
  for (std::size_t e = 0; e < example.size(); ++e) {
    const auto& [recording, result] = example[e];
    const fs::path own = folder.path() / result.estimator.name;
    fs::create_directory(own);
    write_run(own, *recording, result,
              manifest_json(command_line, configuration.in_force, study.description.data,
                            *recording, result, registry));
    write_trajectory_picture(own / "trajectory.png", title + ", " + result.estimator.name,
                             *recording, {result}, e);
    if (recording->camera) try_map_files(own, keyframe_map(*recording, result), on_earth);
    mosaics.push_back({own, placed_pictures(*recording, result.replay.trajectory)});
    results.push_back(result);
  }
  if (pictures != nullptr) write_mosaics(*pictures, mosaics, on_earth, quiet);
  const Recording& last = *example.back().recording;
  write_trajectory_picture(folder.path() / "trajectories.png", title, last, results);
  write_file(folder.path() / "metrics.json", comparison_json(results, last));
  if (configuration.study.association != Association::own) write_recording(folder.path(), last);
  folder.commit(optional_run_files());
}

}  // namespace fathom
