#include "study_example.hpp"

#include "fathom/core/files.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/workflow/trajectory_picture.hpp"
#include "map_files.hpp"
#include "run_mosaics.hpp"

namespace fathom::workflow {

namespace fs = std::filesystem;

void write_example(const ExamplePlace& place, const Study& study,
                   const std::vector<ExampleRun>& example, const EstimatorRegistry& registry,
                   Observer& observer) {
  const Configuration& configuration = study.cells.front();
  StagedFolder folder(place.folder);
  const EarthOrWhyNot earth = earth_or_why_not(configuration);
  if (!earth.why_not.empty()) observer.remark(earth.why_not);
  const EarthFrame* on_earth = earth.frame ? &*earth.frame : nullptr;
  std::vector<Result> results;
  std::vector<RunMosaic> mosaics;
  for (std::size_t e = 0; e < example.size(); ++e) {
    const auto& [recording, result] = example[e];
    const fs::path own = folder.path() / result.estimator.name;
    fs::create_directory(own);
    write_run(own, *recording, result,
              manifest_json(place.made_by, configuration.in_force, study.description.data,
                            *recording, result, registry, place.remarks));
    write_trajectory_picture(own / "trajectory.png", place.title + ", " + result.estimator.name,
                             *recording, {result}, e);
    if (recording->camera) try_map_files(own, keyframe_map(*recording, result), on_earth);
    mosaics.push_back({own, placed_pictures(*recording, result.run.trajectory)});
    results.push_back(result);
  }
  if (place.pictures != nullptr) write_mosaics(*place.pictures, mosaics, on_earth, observer);
  const Recording& last = *example.back().recording;
  write_trajectory_picture(folder.path() / "trajectories.png", place.title, last, results, 0,
                           results.size() == 1);
  write_file(folder.path() / "metrics.json", comparison_json(results, last));
  if (configuration.study.association != Association::own) write_recording(folder.path(), last);
  folder.commit(optional_run_files());
}

}  // namespace fathom::workflow
