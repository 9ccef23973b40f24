// fathom run: a data set, one estimator.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "apps/map_files.hpp"
#include "apps/memory_meter.hpp"
#include "apps/mosaics.hpp"
#include "apps/pictures.hpp"
#include "fathom/core/files.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/loop_remarks.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/map_fit.hpp"
#include "fathom/harness/run_folder.hpp"

namespace fathom {
namespace {

constexpr const char* kBatchOptimum = "batch_optimum";

struct RunFlags {
  CommonFlags common;
  std::string config;
  std::string cache;
  bool no_mosaic = false;
};

Recording record_with_progress(const Recorder& recorder, const Configuration& configuration,
                               bool quiet) {
  ProgressLine line("front end, picture", quiet);
  const TrialNoise noise{static_cast<std::uint64_t>(configuration.seed), 0};
  return recorder.record(configuration, configuration.reference, estimators(), noise,
                         line.front_end_callback());
}

Result evaluate_with_progress(const Recording& recording, const Configuration& configuration,
                              const EstimatorConfiguration& estimator, bool quiet) {
  ProgressLine line(estimator.name + ", keyframe", quiet);
  const auto meter = make_memory_meter();
  ReplayOptions options = replay_options(configuration, estimator);
  options.memory = meter.get();
  options.progress = line.callback();
  return evaluate(recording, estimator, estimators(), {.metrics = metric_options(configuration)},
                  options);
}

// Of what a log may have beside steps and registrations.
void print_absolute(const MeasurementLog& log) {
  if (log.absolute_count() > 0) {
    std::printf("%zu headings and fixes; keyframe 0 begins at %.3g, %.3g m, %.3g rad%s\n",
                log.absolute_count(), log.origin().x, log.origin().y, log.origin().theta,
                log.start().is_fixed() ? ", held" : "");
  }
  if (log.hole_count() > 0) {
    std::printf("%zu of %zu steps of dead reckoning are holes\n", log.hole_count(), log.size() - 1);
  }
}

void print_front_end(const Recording& recording) {
  if (recording.frames.empty()) {
    std::printf("%zu poses, %zu loop closures\n", recording.log.size(),
                recording.log.registration_count());
    print_absolute(recording.log);
    return;
  }
  std::printf("%zu frames, %zu keyframes, %zu registrations tried, %zu found",
              recording.frames.size(), recording.log.size(), recording.registrations_tried,
              recording.log.registration_count());
  if (recording.registrations_left_out > 0) {
    std::printf(", %zu left out beyond the budget", recording.registrations_left_out);
  }
  std::printf("\n");
  if (recording.visual_odometry) {
    std::printf(
        "dead reckoning by visual odometry, %zu of %zu motions repeated for want of a "
        "match\n",
        recording.visual_odometry_failures, recording.frames.size() - 1);
  }
  print_absolute(recording.log);
}

std::string manifest_of(const Context& context, const Configuration& configuration,
                        const Recorder& recorder, const Recording& recording, const Result& result,
                        const std::vector<std::string>& remarks) {
  return manifest_json(
      context.command_line, configuration.in_force,
      with_code(fingerprint(recorder.data().files()), estimators_in({configuration}), estimators()),
      recording, result, estimators(), remarks);
}

// What looks wrong, and the batch optimum of the log where the estimate does not fit it.
struct RunJudgement {
  std::vector<std::string> remarks;
  std::optional<Result> optimum;
};

RunJudgement judged(const Recording& recording, const Configuration& configuration,
                    const Result& result) {
  RunJudgement judgement;
  const std::vector<Pose>& estimate = result.replay.trajectory;
  judgement.remarks = loop_remarks(recording, configuration.front_end, estimate);
  const auto optimum = batch_optimum(recording.log, estimators());
  const auto fit = optimum ? map_fit(recording.log, estimate, *optimum) : std::nullopt;
  if (!fit) return judgement;
  for (const std::string& remark : map_remarks(*fit, result.estimator.name, optimum->solver)) {
    judgement.remarks.push_back(remark);
  }
  if (fit->estimate_fits()) return judgement;
  ReplayOptions options;
  options.mode = SolveMode::batch;
  judgement.optimum = evaluate(recording, {kBatchOptimum, optimum->solver, {}}, estimators(),
                               {.metrics = metric_options(configuration)}, options);
  return judgement;
}

// Of all there is to draw: the run's, and its batch optimum's in a folder below.
std::vector<std::string> write_all_mosaics(const FrameSource& pictures, const Recording& recording,
                                           const std::vector<Result>& results,
                                           const std::filesystem::path& folder,
                                           const EarthFrame* earth, bool quiet) {
  std::vector<RunMosaic> mosaics;
  for (const Result& result : results) {
    mosaics.push_back({mosaics.empty() ? folder : folder / kBatchOptimum,
                       placed_pictures(recording, result.replay.trajectory)});
  }
  std::vector<std::string> lines = write_mosaics(pictures, mosaics, earth, quiet);
  for (std::size_t i = 1; i < lines.size(); ++i) lines[i] = kBatchOptimum + ("/" + lines[i]);
  return lines;
}

// Mosaics, footprints, and where the survey lies on Earth; returns a line each, of what was written
// and of what could not be.
std::vector<std::string> write_maps(const RunFlags& flags, const Configuration& configuration,
                                    const Recorder& recorder, const Recording& recording,
                                    const std::vector<Result>& results,
                                    const std::filesystem::path& folder) {
  if (recorder.pictures() == nullptr) return {};
  std::vector<std::string> lines;
  const EarthOrWhyNot earth = earth_or_why_not(configuration);
  if (!earth.why_not.empty()) lines.push_back(earth.why_not);
  const EarthFrame* on_earth = earth.frame ? &*earth.frame : nullptr;
  if (!flags.no_mosaic) {
    std::ranges::copy(write_all_mosaics(*recorder.pictures(), recording, results, folder, on_earth,
                                        flags.common.quiet),
                      std::back_inserter(lines));
  }
  const auto problem = try_map_files(folder, keyframe_map(recording, results.front()), on_earth);
  if (problem) lines.push_back(*problem);
  return lines;
}

void print_table(const Recording& recording, const std::vector<Result>& results,
                 const Configuration& configuration) {
  std::printf("\n%s", result_table(recording, results).c_str());
  if (recording.ground_truth) {
    std::printf(
        "errors against ground truth, alignment %s; ANEES 1 is expected; cost on one "
        "thread\n",
        name_of(configuration.alignment).c_str());
  }
}

void run(const RunFlags& flags, Context& context) {
  const Settings settings = flags.common.settings(flags.config);
  const Configuration configuration = configure(settings, ConfigurationKind::single, estimators());
  StagedFolder folder(flags.common.folder_or(stem_of(flags.config)),
                      inputs_of(flags.config, settings));
  const std::unique_ptr<RegistrationStore> cache =
      flags.cache.empty() ? nullptr : open_registrations(flags.cache, flags.common.quiet);
  const Recorder recorder(configuration, cache.get());
  const Recording recording = record_with_progress(recorder, configuration, flags.common.quiet);
  std::vector<Result> results{evaluate_with_progress(
      recording, configuration, configuration.estimators.front(), flags.common.quiet)};
  RunJudgement judgement = judged(recording, configuration, results.front());
  write_run(
      folder.path(), recording, results.front(),
      manifest_of(context, configuration, recorder, recording, results.front(), judgement.remarks));
  if (judgement.optimum) {
    results.push_back(std::move(*judgement.optimum));
    std::filesystem::create_directory(folder.path() / kBatchOptimum);
    write_file(folder.path() / kBatchOptimum / "trajectory.tum",
               to_tum(keyframe_trajectory(recording, results.back().replay.trajectory)));
  }
  const Result& result = results.front();
  write_trajectory_picture(folder.path() / "trajectory.png",
                           stem_of(flags.config) + ", " + result.estimator.name, recording,
                           results);
  const std::vector<std::string> maps =
      write_maps(flags, configuration, recorder, recording, results, folder.path());
  folder.commit(optional_run_files());
  context.status = result.is_done() ? kDone : kFailed;
  if (flags.common.quiet) return;
  print_front_end(recording);
  print_table(recording, results, configuration);
  std::printf("\nwrote %s\n", (folder.target() / "trajectory.png").c_str());
  for (const std::string& map : maps) std::printf("      %s\n", map.c_str());
  for (const std::string& remark : judgement.remarks) {
    std::printf("\nwarning: %s\n", remark.c_str());
  }
}

}  // namespace

void add_run(CLI::App& program, Context& context) {
  auto flags = std::make_shared<RunFlags>();
  Command command(program, "run", "Run one estimator over one data set",
                  "Example: fathom run configs/run.yaml --set estimator.type=ekf --out runs/ekf\n"
                  "         fathom run my_survey");
  command.argument(
      "config", flags->config,
      "Configuration (YAML), or a folder of pictures, plain or in the EuRoC/ASL layout");
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name)");
  command.text("--cache", flags->cache, "DIR",
               "Keep registrations in this folder, as compare does: a run that was killed makes "
               "none of them again");
  command.boolean("--no-mosaic", flags->no_mosaic, "No mosaic of the pictures");
  command.on_run([flags, &context] { run(*flags, context); });
}

}  // namespace fathom
