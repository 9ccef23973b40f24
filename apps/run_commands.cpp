// fathom run and fathom compare: a data set, one or several estimators.

#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/memory_meter.hpp"
#include "apps/pictures.hpp"
#include "fathom/core/files.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/study/manifest.hpp"
#include "fathom/study/run_folder.hpp"

namespace fathom {
namespace {

struct RunFlags {
  CommonFlags common;
  std::string config;
};

Recording record_with_progress(const Configuration& configuration, bool quiet) {
  ProgressLine line("front end, frame", quiet);
  return record(configuration, builtin_estimators(), line.callback());
}

Result evaluate_with_progress(const Recording& recording, const Configuration& configuration,
                              const EstimatorConfiguration& estimator, bool quiet) {
  ProgressLine line(estimator.name + ", keyframe", quiet);
  const auto meter = make_memory_meter();
  ReplayOptions options;
  options.memory = meter.get();
  options.progress = line.callback();
  return evaluate(recording, estimator, builtin_estimators(), configuration.alignment, options);
}

void print_front_end(const Recording& recording) {
  if (recording.frames.empty()) {
    std::printf("%zu poses, %zu loop closures\n", recording.log.size(),
                recording.log.registration_count());
    return;
  }
  std::printf("%zu frames, %zu keyframes, %zu registrations tried, %zu found\n",
              recording.frames.size(), recording.log.size(), recording.registrations_tried,
              recording.log.registration_count());
  if (recording.visual_odometry) {
    std::printf(
        "dead reckoning by visual odometry, %zu of %zu motions repeated for want of a "
        "match\n",
        recording.visual_odometry_failures, recording.frames.size() - 1);
  }
}

std::string manifest_of(const Context& context, const Configuration& configuration,
                        const Recording& recording, const Result& result) {
  return manifest_json(context.command_line, configuration.in_force, recording, result,
                       builtin_estimators());
}

void print_table(const Recording& recording, const std::vector<Result>& results,
                 const Configuration& configuration) {
  std::printf("\n%s", result_table(recording, results, configuration.alignment).c_str());
  if (recording.ground_truth) {
    std::printf(
        "errors against ground truth, alignment %s; ANEES 1 is expected; cost on one "
        "thread\n",
        name_of(configuration.alignment).c_str());
  }
}

void run(const RunFlags& flags, Context& context) {
  const Configuration configuration = configure(flags.common.settings(flags.config),
                                                ConfigurationKind::single, builtin_estimators());
  StagedFolder folder(flags.common.folder_or(stem_of(flags.config)));
  const Recording recording = record_with_progress(configuration, flags.common.quiet);
  const std::vector<Result> results{evaluate_with_progress(
      recording, configuration, configuration.estimators.front(), flags.common.quiet)};
  const Result& result = results.front();
  write_run(folder.path(), recording, result,
            manifest_of(context, configuration, recording, result));
  write_trajectory_picture(folder.path() / "trajectory.png",
                           stem_of(flags.config) + ", " + result.estimator.name, recording,
                           results);
  folder.commit(optional_run_files());
  context.status = result.is_done() ? kDone : kFailed;
  if (flags.common.quiet) return;
  print_front_end(recording);
  print_table(recording, results, configuration);
  std::printf("\nwrote %s\n", (folder.target() / "trajectory.png").c_str());
}

void compare(const RunFlags& flags, Context& context) {
  const Configuration configuration = configure(
      flags.common.settings(flags.config), ConfigurationKind::comparison, builtin_estimators());
  StagedFolder folder(flags.common.folder_or(stem_of(flags.config)));
  const Recording recording = record_with_progress(configuration, flags.common.quiet);
  std::vector<Result> results;
  context.status = kDone;
  for (const EstimatorConfiguration& estimator : configuration.estimators) {
    results.push_back(
        evaluate_with_progress(recording, configuration, estimator, flags.common.quiet));
    const Result& result = results.back();
    if (!result.is_done()) context.status = kFailed;
    const std::filesystem::path own = folder.path() / estimator.name;
    std::filesystem::create_directory(own);
    write_run(own, recording, result, manifest_of(context, configuration, recording, result));
    write_trajectory_picture(own / "trajectory.png", stem_of(flags.config) + ", " + estimator.name,
                             recording, {result});
  }
  write_trajectory_picture(folder.path() / "trajectories.png", stem_of(flags.config), recording,
                           results);
  write_file(folder.path() / "table.txt",
             result_table(recording, results, configuration.alignment));
  write_file(folder.path() / "metrics.json", comparison_json(results, recording));
  write_recording(folder.path(), recording);
  folder.commit(optional_run_files());
  if (flags.common.quiet) return;
  print_front_end(recording);
  print_table(recording, results, configuration);
  if (configuration.dataset != DatasetType::g2o) {
    std::printf("one log for all, its loop candidates picked by %s\n",
                configuration.estimators[configuration.reference].name.c_str());
  }
  std::printf("\nwrote %s\n", (folder.target() / "trajectories.png").c_str());
  for (const Result& result : results) {
    std::printf("      %s\n", (folder.target() / result.estimator.name / "trajectory.png").c_str());
  }
}

template <class Action>
void add(CLI::App& app, Context& context, const std::string& name, const std::string& help,
         const std::string& example, Action action) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = app.add_subcommand(name, help);
  command->footer("Example: " + example);
  command->add_option("config", flags->config, "Configuration (YAML)")->required();
  flags->common.add_settings_to(*command);
  flags->common.add_out_to(*command, "Output folder (default: runs/CONFIG's name)");
  command->callback([flags, &context, action] { action(*flags, context); });
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  add(app, context, "run", "Run one estimator over one data set",
      "fathom run configs/run.yaml --set estimator.type=ekf --out runs/ekf", run);
}

void add_compare(CLI::App& app, Context& context) {
  add(app, context, "compare", "Run several estimators on one shared measurement log",
      "fathom compare configs/quickstart.yaml --out runs/quickstart", compare);
}

}  // namespace fathom
