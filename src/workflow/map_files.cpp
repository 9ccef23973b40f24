#include "map_files.hpp"

#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "fathom/report/footprints.hpp"

namespace fathom::workflow {

KeyframeMap keyframe_map(const Recording& recording, const Result& result) {
  KeyframeMap map{*recording.camera, {}, recording.keyframe_stances, std::vector<TrackLoop>{}};
  const Run& run = result.run;
  for (std::size_t k = 0; k < run.trajectory.size(); ++k) {
    TrackPoint point{recording.keyframe_times_ns[k], run.trajectory[k], std::nullopt};
    if (run.covariances && k < run.covariances->size()) {
      point.covariance = (*run.covariances)[k];
    }
    map.track.push_back(point);
  }
  for (const LoopDecision& loop : run.loops) {
    map.loops->push_back({loop.from, loop.to, name_of(loop.fate)});
  }
  return map;
}

void write_map_files(const std::filesystem::path& folder, const KeyframeMap& map,
                     const EarthFrame* earth) {
  std::vector<KeyframePicture> keyframes;
  for (std::size_t k = 0; k < map.track.size(); ++k) {
    keyframes.push_back({map.track[k].time_ns, map.stances[k], map.track[k].pose});
  }
  const std::vector<Footprint> all = footprints(map.camera, keyframes);
  write_file(folder / "footprints.csv", footprints_csv(all));
  if (earth == nullptr) return;
  write_file(folder / "footprints.geojson", footprints_geojson(*earth, all));
  write_file(folder / "trajectory.geojson", track_geojson(*earth, map.track));
  if (map.loops) {
    write_file(folder / "loops.geojson", loops_geojson(*earth, map.track, *map.loops));
  }
}

std::optional<std::string> try_map_files(const std::filesystem::path& folder,
                                         const KeyframeMap& map, const EarthFrame* earth) {
  try {
    write_map_files(folder, map, earth);
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError& error) {
    return std::string("no map of all footprints: ") + error.what();
  }
  return std::nullopt;
}

const std::vector<std::string>& map_file_names() {
  static const std::vector<std::string> names{"footprints.csv", "footprints.geojson",
                                              "loops.geojson", "trajectory.geojson"};
  return names;
}

std::optional<EarthFrame> earth_of(const Configuration& configuration) {
  const std::optional<EarthOrigin> origin = configuration.origin.origin();
  if (!origin) return std::nullopt;
  return EarthFrame(*origin);
}

EarthOrWhyNot earth_or_why_not(const Configuration& configuration) {
  try {
    return {earth_of(configuration), ""};
  } catch (const InputError& error) {
    return {std::nullopt, std::string("no map on Earth: ") + error.what()};
  }
}

}  // namespace fathom::workflow
