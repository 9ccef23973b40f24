// fathom run: a data set, one estimator.

#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/workflow/inputs.hpp"
#include "fathom/workflow/result_table.hpp"
#include "fathom/workflow/run.hpp"

namespace fathom {
namespace {

struct RunFlags {
  CommonFlags common;
  std::string config;
  CacheFlags cache;
  bool no_mosaic = false;
};

// Of what a log may have beside steps and registrations.
void print_absolute(const MeasurementLog& log) {
  if (log.absolute_count() > 0) {
    print("%zu headings and fixes; keyframe 0 begins at %.3g, %.3g m, %.3g rad%s\n",
          log.absolute_count(), log.origin().x, log.origin().y, log.origin().theta,
          log.start().is_fixed() ? ", held" : "");
  }
  if (log.hole_count() > 0) {
    print("%zu of %zu steps of dead reckoning are holes\n", log.hole_count(), log.size() - 1);
  }
}

void print_front_end(const Recording& recording) {
  if (recording.frames.empty()) {
    print("%zu poses, %zu loop closures\n", recording.log.size(),
          recording.log.registration_count());
    print_absolute(recording.log);
    return;
  }
  print("%zu frames, %zu keyframes, %zu registrations tried, %zu found", recording.frames.size(),
        recording.log.size(), recording.registrations_tried, recording.log.registration_count());
  if (recording.registrations_from_cache > 0) {
    print(", %zu from the cache", recording.registrations_from_cache);
  }
  if (recording.registrations_left_out > 0) {
    print(", %zu left out beyond the budget", recording.registrations_left_out);
  }
  print("\n");
  if (recording.visual_odometry) {
    print(
        "dead reckoning by visual odometry, %zu of %zu motions repeated for want of a "
        "match\n",
        recording.visual_odometry_failures, recording.frames.size() - 1);
  }
  for (const FoundSigma& sigma : recording.found_sigmas) {
    print("%s\n", words(sigma).c_str());
  }
  print_absolute(recording.log);
}

void print_table(const workflow::RunOutcome& done) {
  std::vector<Result> results{done.result};
  if (done.optimum) results.push_back(*done.optimum);
  print("\n%s", workflow::result_table(*done.recording, results).c_str());
  if (done.recording->ground_truth) {
    print(
        "errors against ground truth, alignment %s; ANEES 1 is expected; cost on one "
        "thread\n",
        name_of(done.alignment).c_str());
  }
}

void run(const RunFlags& flags, Context& context) {
  workflow::RunRequest request;
  request.settings = flags.common.settings(flags.config, workflow::NamedPlugins::loaded);
  request.inputs = workflow::inputs_of(flags.config, request.settings);
  request.title = workflow::stem_of(flags.config);
  request.out = flags.common.folder_or(request.title);
  request.made_by = context.command_line;
  request.mosaics = !flags.no_mosaic;
  const std::unique_ptr<RegistrationStore> cache = flags.cache.open(flags.common.quiet);
  request.registrations = cache.get();
  Terminal terminal(flags.common.quiet);
  const workflow::RunOutcome done =
      workflow::run(request, flags.common.estimators(), this_program(), terminal);
  terminal.clear();
  context.status = done.result.is_done() ? kDone : kFailed;
  if (flags.common.quiet) return;
  print_front_end(*done.recording);
  print_table(done);
  print("\n");
  terminal.print_written();
  terminal.print_remarks();
}

}  // namespace

void add_run(CLI::App& program, Context& context) {
  auto flags = std::make_shared<RunFlags>();
  Command command(program, "run", "Run one estimator over one data set",
                  "Example: fathom run configs/run.yaml --set estimator.type=ekf --out runs/ekf\n"
                  "         fathom run my_survey\n"
                  "         fathom run intel.g2o");
  command.argument(
      "config", flags->config,
      "Configuration (YAML), a folder of pictures, plain or in the EuRoC/ASL layout, or a pose "
      "graph (.g2o, .graph)");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name)");
  flags->cache.add_to(command);
  command.boolean("--no-mosaic", flags->no_mosaic, "No mosaic of the pictures");
  command.on_run([flags, &context] { run(*flags, context); });
}

}  // namespace fathom
