// fathom mosaic: the pictures of a run, laid where a trajectory has them.

#include <memory>
#include <optional>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/workflow/mosaic.hpp"

namespace fathom {
namespace {

struct MosaicFlags {
  CommonFlags common;
  std::string run;
  std::string trajectory;
  std::optional<double> metres_per_pixel;
  double max_difference_s = 0.01;
  std::optional<int> tile_px;
  std::string blend = "feather";
};

void make(const MosaicFlags& flags, Context& context) {
  workflow::MosaicRequest request;
  request.run = flags.run;
  request.settings = flags.common.settings("");
  request.trajectory = flags.trajectory;
  request.metres_per_pixel = flags.metres_per_pixel;
  request.max_difference_s = flags.max_difference_s;
  request.tile_px = flags.tile_px;
  request.blend = flags.blend == "seams" ? MosaicBlend::seams : MosaicBlend::feather;
  request.out = flags.common.out;
  Terminal terminal(flags.common.quiet);
  const workflow::MosaicOutcome done =
      workflow::mosaic(request, flags.common.estimators(), terminal);
  terminal.clear();
  context.status = kDone;
  if (flags.common.quiet) return;
  print("%zu of %zu frames have a pose; laid: %s\n\n", done.with_pose, done.frames,
        done.laid.c_str());
  terminal.print_written();
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
  command.choice(
      "--blend", flags->blend, {"feather", "seams"}, "BLEND",
      "Where pictures overlap: their mean, which shows what is misplaced; or the nearest "
      "one, at equal exposure");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/RUN's name-TRAJECTORY's name)");
  command.on_run([flags, &context] { make(*flags, context); });
}

}  // namespace fathom
