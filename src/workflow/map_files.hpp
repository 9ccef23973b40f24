#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/report/earth_frame.hpp"
#include "fathom/report/geo_json.hpp"

namespace fathom::workflow {

/// The keyframes of an estimate over pictures, as they leave for other programs.
struct KeyframeMap {
  Camera camera;
  std::vector<TrackPoint> track;
  std::vector<Stance> stances;  ///< one a keyframe
  std::optional<std::vector<TrackLoop>> loops = std::nullopt;
};

/// Of a run over pictures.
KeyframeMap keyframe_map(const Recording& recording, const Result& result);

/// `footprints.csv`; on Earth also `footprints.geojson`, `trajectory.geojson` and, where loops are
/// known, `loops.geojson`. Throws InputError of an estimate gone wild.
void write_map_files(const std::filesystem::path& folder, const KeyframeMap& map,
                     const EarthFrame* earth);

/// The same, but a run is worth keeping without: a line that says why not, or nothing.
std::optional<std::string> try_map_files(const std::filesystem::path& folder,
                                         const KeyframeMap& map, const EarthFrame* earth);

/// Names of all files that those may be.
const std::vector<std::string>& map_file_names();

/// Where the configuration says that its survey starts on Earth. Throws InputError where Fathom was
/// built without what that takes.
std::optional<EarthFrame> earth_of(const Configuration& configuration);

/// The same, for what is worth doing without.
struct EarthOrWhyNot {
  std::optional<EarthFrame> frame;
  std::string why_not;  ///< a line; empty where there is a frame, or none is asked for
};
EarthOrWhyNot earth_or_why_not(const Configuration& configuration);

}  // namespace fathom::workflow
