// fathom mosaic: the pictures of a run, laid where a trajectory has them.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "apps/map_files.hpp"
#include "apps/mosaics.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct MosaicFlags {
  CommonFlags common;
  std::string run;
  std::string trajectory;
  std::optional<double> metres_per_pixel;
  double max_difference_s = 0.01;
  std::optional<int> tile_px;

  /// The run's settings, then --set and --seed.
  Settings settings() const {
    Settings settings = data_settings_of_run(run);
    const Settings given = common.settings("");
    for (const Setting& setting : given.all()) {
      if (setting.key != "seed" && !setting.key.starts_with("dataset.")) {
        refuse(setting, setting.key + ": a mosaic depends on dataset.… and seed alone");
      }
      settings.put(setting);
    }
    return settings;
  }

  /// --trajectory, or the run's own estimate.
  fs::path trajectory_file() const {
    return trajectory.empty() ? fs::path(run) / "frames.tum" : fs::path(trajectory);
  }

  std::string default_folder() const {
    const fs::path folder = fs::path(run).lexically_normal();
    const fs::path name =
        folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    return name.string() + "-" + trajectory_file().stem().string();
  }
};

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
std::string lay(const MosaicFlags& flags, const fs::path& folder, const FrameSource& frames,
                const std::vector<PlacedPicture>& pictures, const EarthFrame* earth) {
  if (!flags.tile_px) {
    return write_mosaic(folder, frames, pictures, {flags.metres_per_pixel, earth},
                        flags.common.quiet);
  }
  return write_tiled_mosaic(folder, frames, pictures, {flags.metres_per_pixel, earth},
                            *flags.tile_px, flags.common.quiet);
}

void make(const MosaicFlags& flags, Context& context) {
  const Configuration configuration =
      configure(flags.settings(), ConfigurationKind::single, estimators());
  const std::optional<EarthFrame> earth = earth_of(configuration);
  const EarthFrame* on_earth = earth ? &*earth : nullptr;
  const Survey survey(configuration);
  const FrameSource& frames = survey.measured();
  std::vector<PlacedPicture> pictures =
      pictures_on(flags.trajectory_file(), frames, flags.max_difference_s);
  if (flags.trajectory.empty()) {
    mark_fillers(pictures, frames, fs::path(flags.run) / "trajectory.tum");
  }
  std::vector<fs::path> inputs = inputs_of(fs::path(flags.run) / "run.json", flags.settings());
  inputs.push_back(flags.trajectory_file());
  StagedFolder folder(flags.common.folder_or(flags.default_folder()), inputs);
  const std::string laid = lay(flags, folder.path(), frames, pictures, on_earth);
  write_map_files(folder.path(), keyframe_map_of(pictures, frames), on_earth);
  folder.commit(mosaic_file_names());
  context.status = kDone;
  if (flags.common.quiet) return;
  std::printf("%zu of %zu frames have a pose; laid: %s\n\nwrote %s\n", pictures.size(),
              frames.size(), laid.c_str(),
              (folder.target() / (flags.tile_px ? "tiles" : "mosaic.png")).c_str());
  if (earth) {
    std::printf("      %s (%s)\n", (folder.target() / "mosaic.tif").c_str(), earth->name().c_str());
  }
}

}  // namespace

void add_mosaic(CLI::App& program, Context& context) {
  auto flags = std::make_shared<MosaicFlags>();
  Command command(
      program, "mosaic", "Lay a run's pictures where a trajectory has them",
      "Example: fathom mosaic runs/run --trajectory runs/run/ground_truth.tum --out truth\n"
      "         fathom mosaic runs/run --tile-size 2048 --out tiles\n"
      "Writes mosaic.png, x up and y to the left, and mosaic.json and mosaic.pgw, which say where "
      "it\n"
      "lies; footprints.csv; where dataset.origin says where the survey starts on Earth, "
      "mosaic.tif,\n"
      "north up, trajectory.geojson and footprints.geojson.");
  command.argument("run", flags->run, "Folder of a run over pictures");
  command.text("--trajectory", flags->trajectory, "FILE",
               "Trajectory (TUM), of all frames or some (default: the run's frames.tum)");
  command.real("--resolution", flags->metres_per_pixel, Range::positive(), "M",
               "Metres per pixel (default: what a pixel of a picture covers)");
  command.real("--max-difference", flags->max_difference_s, Range::at_least(0.0), "S",
               "A pose is of a picture whose time stamp differs by no more (s)");
  command.integer("--tile-size", flags->tile_px, Range::between(64, 16384), "PX",
                  "Tiles of so many pixels a side in place of one picture: full resolution and "
                  "little memory, however large the mosaic");
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/RUN's name-TRAJECTORY's name)");
  command.on_run([flags, &context] { make(*flags, context); });
}

}  // namespace fathom
