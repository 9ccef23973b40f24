// fathom mosaic: the pictures of a run, laid where a trajectory has them.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/mosaics.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/estimators/builtin.hpp"
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
    pictures.push_back({pair.reference, frames.info(pair.reference).altitude_m,
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

void make(const MosaicFlags& flags, Context& context) {
  const Configuration configuration =
      configure(flags.settings(), ConfigurationKind::single, builtin_estimators());
  const Survey survey(configuration);
  const FrameSource& frames = survey.measured();
  std::vector<PlacedPicture> pictures =
      pictures_on(flags.trajectory_file(), frames, flags.max_difference_s);
  if (flags.trajectory.empty()) {
    mark_fillers(pictures, frames, fs::path(flags.run) / "trajectory.tum");
  }
  MosaicOptions options;
  options.metres_per_pixel = flags.metres_per_pixel;
  const MosaicPlan plan = plan_mosaic(frames.camera(), pictures, options);
  std::vector<fs::path> inputs = inputs_of(fs::path(flags.run) / "run.json", flags.settings());
  inputs.push_back(flags.trajectory_file());
  StagedFolder folder(flags.common.folder_or(flags.default_folder()), inputs);
  {
    ProgressLine line("mosaic, picture", flags.common.quiet);
    write_mosaic(folder.path(), plan, make_mosaics(frames, {&plan, 1}, line.callback()).front());
  }
  folder.commit();
  context.status = kDone;
  if (flags.common.quiet) return;
  std::printf("%zu of %zu frames have a pose; laid: %s\n\nwrote %s\n", pictures.size(),
              frames.size(), mosaic_text(plan).c_str(), (folder.target() / "mosaic.png").c_str());
}

}  // namespace

void add_mosaic(CLI::App& program, Context& context) {
  auto flags = std::make_shared<MosaicFlags>();
  Command command(
      program, "mosaic", "Lay a run's pictures where a trajectory has them",
      "Example: fathom mosaic runs/run --trajectory runs/run/ground_truth.tum --out truth\n"
      "Writes mosaic.png, x up and y to the left, and mosaic.json, which says where it lies.");
  command.argument("run", flags->run, "Folder of a run over pictures");
  command.text("--trajectory", flags->trajectory, "FILE",
               "Trajectory (TUM), of all frames or some (default: the run's frames.tum)");
  command.real("--resolution", flags->metres_per_pixel, Range::positive(), "M",
               "Metres per pixel (default: what a pixel of a picture covers)");
  command.real("--max-difference", flags->max_difference_s, Range::at_least(0.0), "S",
               "A pose is of a picture whose time stamp differs by no more (s)");
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/RUN's name-TRAJECTORY's name)");
  command.on_run([flags, &context] { make(*flags, context); });
}

}  // namespace fathom
