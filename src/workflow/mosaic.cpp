#include "fathom/workflow/mosaic.hpp"

#include <algorithm>
#include <set>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/inputs.hpp"
#include "map_files.hpp"
#include "run_mosaics.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

// The run's settings, then those that are given.
Settings settings_in_force(const MosaicRequest& request) {
  Settings settings = data_settings_of_run(request.run);
  for (const Setting& setting : request.settings.all()) {
    if (setting.key != "seed" && !setting.key.starts_with("dataset.")) {
      refuse(setting, setting.key + ": a mosaic depends on dataset.… and seed alone");
    }
    settings.put(setting);
  }
  return settings;
}

fs::path default_folder(const MosaicRequest& request, const fs::path& trajectory) {
  const fs::path folder = request.run.lexically_normal();
  const fs::path name = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  return fs::path("runs") / (name.string() + "-" + trajectory.stem().string());
}

std::vector<PlacedPicture> pictures_on(const fs::path& file, const FrameSource& frames,
                                       double max_difference_s) {
  const std::vector<StampedPose> trajectory = read_tum(file);
  std::vector<StampedPose> times;
  for (std::size_t i = 0; i < frames.size(); ++i) times.push_back({frames.info(i).time_ns, {}});
  std::vector<PlacedPicture> pictures;
  for (const PosePair& pair : associate(trajectory, times, max_difference_s)) {
    pictures.push_back({pair.reference, frames.info(pair.reference).stance(),
                        trajectory[pair.estimate].pose, false});
  }
  if (pictures.empty()) {
    throw InputError(file.string(), "no pose is within " + format_number(max_difference_s, 3) +
                                        " s of a picture of the run; --max-difference may be "
                                        "larger");
  }
  return pictures;
}

// Of the run's own estimate: what lies between its keyframes.
void mark_fillers(std::vector<PlacedPicture>& pictures, const FrameSource& frames,
                  const fs::path& keyframe_file) {
  std::set<std::int64_t> keyframes;
  for (const StampedPose& pose : read_tum(keyframe_file)) keyframes.insert(pose.time_ns);
  for (PlacedPicture& picture : pictures) {
    picture.is_filler = !keyframes.contains(frames.info(picture.frame).time_ns);
  }
}

bool is_own_estimate(const MosaicRequest& request) {
  std::error_code error;
  const auto is = [&](const char* name) {
    return fs::equivalent(request.trajectory, request.run / name, error);
  };
  return request.trajectory.empty() || is("frames.tum") || is("trajectory.tum");
}

// Into the run's own folder goes a mosaic of its own estimate alone: maps of another one would
// stand beside figures that are not of it. Returns whether it goes there.
bool goes_to_its_run(const MosaicRequest& request, const fs::path& out) {
  std::error_code error;
  if (!fs::exists(out / "run.json", error)) return false;
  const bool is_placed_anew = std::ranges::any_of(request.settings.all(), [](const auto& setting) {
    return setting.key.starts_with("dataset.origin");
  });
  if (fs::equivalent(out, request.run, error) && is_own_estimate(request) && !is_placed_anew) {
    return true;
  }
  throw InputError(out.string(),
                   "is the folder of a run, whose maps are those of its estimate; --out takes "
                   "another place");
}

// What the mosaic shows of the keyframes, or of every pose of a trajectory that is given.
KeyframeMap keyframe_map_of(const std::vector<PlacedPicture>& pictures, const FrameSource& frames) {
  KeyframeMap map{frames.camera(), {}, {}};
  for (const PlacedPicture& picture : pictures) {
    if (picture.is_filler) continue;
    map.track.push_back({frames.info(picture.frame).time_ns, picture.pose, std::nullopt});
    map.stances.push_back(picture.stance);
  }
  return map;
}

// Returns what was laid, in words.
std::string lay(const MosaicRequest& request, const fs::path& folder, const FrameSource& frames,
                const std::vector<PlacedPicture>& pictures, const EarthFrame* earth,
                Observer& observer) {
  const AskedMosaic asked{request.metres_per_pixel, earth, request.blend};
  if (!request.tile_px) return write_mosaic(folder, frames, pictures, asked, observer);
  return write_tiled_mosaic(folder, frames, pictures, asked, *request.tile_px, observer);
}

}  // namespace

MosaicOutcome mosaic(const MosaicRequest& request, const EstimatorRegistry& registry,
                     Observer& observer) {
  const Settings settings = settings_in_force(request);
  const Configuration configuration = configure(settings, ConfigurationKind::single, registry);
  const std::optional<EarthFrame> earth = earth_of(configuration);
  const EarthFrame* on_earth = earth ? &*earth : nullptr;
  const Survey survey(configuration);
  const FrameSource& frames = survey.measured();
  const fs::path trajectory =
      request.trajectory.empty() ? request.run / "frames.tum" : request.trajectory;
  std::vector<PlacedPicture> pictures = pictures_on(trajectory, frames, request.max_difference_s);
  if (request.trajectory.empty()) mark_fillers(pictures, frames, request.run / "trajectory.tum");
  std::vector<fs::path> inputs = inputs_of(request.run / "run.json", settings);
  inputs.push_back(trajectory);
  const fs::path out = request.out.empty() ? default_folder(request, trajectory) : request.out;
  const bool is_in_its_run = goes_to_its_run(request, out);
  StagedFolder folder(out, inputs);
  const std::string laid = lay(request, folder.path(), frames, pictures, on_earth, observer);
  std::vector<std::string> own = mosaic_file_names();
  // The run's own map files are there, and say more: the spread of each pose, and loops.
  if (!is_in_its_run) {
    write_map_files(folder.path(), keyframe_map_of(pictures, frames), on_earth);
    own.insert(own.end(), map_file_names().begin(), map_file_names().end());
  }
  folder.commit(own);
  observer.wrote((folder.target() / (request.tile_px ? "tiles" : "mosaic.png")).string());
  if (earth) {
    observer.wrote((folder.target() / "mosaic.tif").string() + " (" + earth->name() + ")");
  }
  return {pictures.size(), frames.size(), laid};
}

}  // namespace fathom::workflow
