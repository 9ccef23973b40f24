// fathom solve: a pose graph from a g2o file.

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/estimators.hpp"
#include "apps/graph_keys.hpp"
#include "apps/memory_meter.hpp"
#include "apps/pictures.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

struct SolveFlags {
  CommonFlags common;
  std::string graph;
  std::string estimator;
  std::string mode;
  std::string init = "odometry";
  std::string ground_truth;
  std::string false_loops;
  std::optional<int> component;
};

EstimatorConfiguration estimator_of(const SolveFlags& flags, const Settings& settings,
                                    SolveMode& mode) {
  std::string type = flags.estimator;
  const Setting* other = nullptr;
  for (const Setting& setting : settings.all()) {
    if (setting.key == "estimator.type") {
      if (!flags.estimator.empty()) refuse(setting, "--estimator says it already");
      type = word_of(setting, setting.key);
    } else if (setting.key == "seed") {
      // Nothing here is random; it is checked as everywhere.
      Settings seed;
      seed.put(setting);
      configure(seed, ConfigurationKind::single, estimators());
    } else if (setting.key != "plugins" && !is_isolation_key(setting.key) &&
               !setting.key.starts_with("estimator.") && !is_graph_key(setting.key)) {
      other = &setting;
    }
  }
  const EstimatorEntry& entry = estimators().find(type.empty() ? "ceres_pose_graph" : type);
  if (other != nullptr) {
    std::vector<std::string> known{"seed", "estimator.type"};
    for (const OptionDescription& option : entry.options)
      known.push_back("estimator." + option.key);
    std::ranges::copy(graph_keys(), std::back_inserter(known));
    refuse(*other, "unknown key '" + other->key + "'" + suggestion(other->key, known) +
                       " ('solve' takes estimator.…, seed, and of dataset.… what a graph has)");
  }
  mode = flags.mode == "batch" || (flags.mode.empty() && entry.can_batch) ? SolveMode::batch
                                                                          : SolveMode::incremental;
  if (mode == SolveMode::batch && !entry.can_batch) {
    throw InputError("--mode batch: " + entry.name +
                     " takes a log in its order, keyframe by keyframe; use --mode incremental");
  }
  if (mode == SolveMode::incremental && flags.init == "file") {
    throw InputError("--init file: only a batch solve has a start; use --mode batch");
  }
  const Setting* start = settings.find("estimator.start");
  if (start != nullptr && flags.init == "file") {
    const std::string& word = word_of(*start, "estimator.start");
    if (word != "auto" && word != "given") {
      refuse(*start,
             "estimator.start: " + word + " makes a start of its own and would ignore --init file");
    }
  }
  Settings own;
  const Settings given = settings.below("estimator.");
  for (const Setting& setting : given.all()) {
    if (setting.key != "type") own.put(setting);
  }
  return {entry.name, entry.name, estimator_values(own, entry, {{}, mode}, "estimator.")};
}

IsolationOptions isolation_of(const Settings& settings, const EstimatorEntry& entry) {
  IsolationOptions options;
  OptionTable table;
  options.describe(table);
  for (const Setting& setting : settings.all()) {
    if (!is_isolation_key(setting.key)) continue;
    try {
      table.set(setting.key, setting.value);
    } catch (const InputError& error) {
      refuse(setting, error.what());
    }
  }
  if (options.is_isolated(entry)) return options;
  for (const Setting& setting : settings.all()) {
    if (!is_isolation_key(setting.key) || setting.key == "isolation") continue;
    refuse(setting, setting.key + ": " + entry.name +
                        " runs in no process of its own, and it would be ignored; isolation: "
                        "process gives it one");
  }
  return options;
}

std::string chi2_text(const Result& result, const char* metric) {
  constexpr int kDigits = 10;
  return format_number(result.metric(metric), kDigits);
}

std::string counted(std::size_t count, const std::string& noun) {
  return ", " + std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string also_text(const MeasurementLog& log) {
  std::string text;
  if (log.absolute_count() > 0) text += counted(log.absolute_count(), "absolute measurement");
  if (log.hole_count() > 0) text += counted(log.hole_count(), "hole");
  if (log.start().is_free) return text + ", free start";
  return log.start().is_fixed() ? text : text + ", uncertain start";
}

void print(const SolveFlags& flags, const Recording& recording, const Result& result) {
  const MeasurementLog& log = recording.log;
  std::printf("%s: %zu poses, %zu edges, %zu of them loop closures%s\n", flags.graph.c_str(),
              log.size(), log.size() - 1 - log.hole_count() + log.registration_count(),
              log.registration_count(), also_text(log).c_str());
  std::printf("%s, %s: %s after %d iterations\n", result.estimator.type.c_str(),
              result.mode == SolveMode::batch ? "batch" : "incremental",
              name_of(result.replay.outcome).c_str(), result.replay.iterations);
  std::printf("chi2 %s, from %s at the start\n", chi2_text(result, "chi2").c_str(),
              chi2_text(result, "chi2_initial").c_str());
  if (result.replay.gradient_norm) {
    std::printf("gradient %.2g", *result.replay.gradient_norm);
    if (result.replay.is_local_minimum) {
      std::printf(", %s", *result.replay.is_local_minimum ? "a local minimum" : "no local minimum");
    }
    std::printf("\n");
  }
  if (const auto given = result.metric("absolute_measurements")) {
    std::printf("absolute measurements: %.0f of %.0f used, %.0f rejected, %.0f lost, chi2 %s\n",
                result.metrics.at("absolute_used"), *given, result.metrics.at("absolute_rejected"),
                result.metrics.at("absolute_lost"), chi2_text(result, "absolute_chi2").c_str());
  }
  if (const auto false_loops = result.metric("false_loops")) {
    std::printf("%.0f of %.0f false loops kept, %.0f right ones lost\n",
                result.metrics.at("false_loops_kept"), *false_loops,
                result.metrics.at("right_loops_lost"));
  }
  std::printf("\n");
  std::printf("%s", result_table(recording, {result}).c_str());
}

void solve(const SolveFlags& flags, Context& context) {
  SolveMode mode = SolveMode::incremental;
  const Settings settings = flags.common.settings("");
  const EstimatorConfiguration estimator = estimator_of(flags, settings, mode);
  const GraphOptions graph = graph_options(settings, flags.component);
  Recording recording = record_graph(flags.graph, graph);
  // Keyframe by keyframe needs a start; one solve takes it from all that there is.
  if (mode == SolveMode::incremental) {
    recording.log = with_start_of_priors(recording.log, flags.graph);
  }
  if (!flags.ground_truth.empty()) attach_ground_truth(recording, flags.ground_truth);
  if (!flags.false_loops.empty()) {
    recording.is_false_loop = read_false_loops(flags.false_loops, recording.log);
  }
  ReplayOptions options;
  options.mode = mode;
  options.isolation = isolation_of(settings, estimators().find(estimator.type));
  if (flags.init == "file") {
    if (!recording.log.guess) {
      throw InputError(flags.graph, "has no vertices to start from; use --init odometry");
    }
    options.start = *recording.log.guess;
  }
  StagedFolder folder(flags.common.folder_or(stem_of(flags.graph) + "-" + estimator.type),
                      {flags.graph, flags.ground_truth, flags.false_loops});
  const auto meter = make_memory_meter();
  options.memory = meter.get();
  ProgressLine line(estimator.type + ", keyframe", flags.common.quiet);
  options.progress = line.callback();
  const Result result = evaluate(recording, estimator, estimators(), {}, options);
  std::vector<std::pair<std::string, std::string>> configuration{{"graph", flags.graph},
                                                                 {"init", flags.init}};
  std::ranges::copy(in_force(graph, recording.log), std::back_inserter(configuration));
  write_run(folder.path(), recording, result,
            manifest_json(context.command_line, configuration,
                          with_code(fingerprint({flags.graph}), {estimator}, estimators()),
                          recording, result, estimators()));
  write_trajectory_picture(folder.path() / "trajectory.png",
                           stem_of(flags.graph) + ", " + estimator.type, recording, {result});
  folder.commit(optional_run_files());
  context.status = result.is_done() ? kDone : kFailed;
  if (flags.common.quiet) return;
  print(flags, recording, result);
  std::printf("\nwrote %s\n", (folder.target() / "trajectory.png").c_str());
}

}  // namespace

void add_solve(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SolveFlags>();
  Command command(program, "solve", "Solve a pose graph",
                  "Example: fathom solve intel.g2o --estimator ceres_pose_graph --mode batch\n"
                  "         fathom solve ring.g2o --estimator trajectory_iekf --set "
                  "estimator.max_iterations=3");
  command.argument("graph", flags->graph, "Pose graph (g2o)");
  command.text("--estimator", flags->estimator, "ESTIMATOR",
               "Estimator (default: ceres_pose_graph)");
  command.choice("--mode", flags->mode, {"incremental", "batch"}, "MODE",
                 "incremental: keyframe by keyframe; batch: one solve (default where it can)");
  command.choice("--init", flags->init, {"odometry", "file"}, "START",
                 "Where a batch solve starts: odometry or file");
  command.text("--ground-truth", flags->ground_truth, "FILE",
               "True poses (TUM, vertex ids as time stamps), to judge by");
  command.text("--false-loops", flags->false_loops, "FILE",
               "Which loops are false, as 'spoil' wrote it, to judge by");
  command.integer("--component", flags->component, Range::at_least(1), "K",
                  "Of a graph that falls into several, this one ('check' lists them)");
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/GRAPH-ESTIMATOR)");
  command.on_run([flags, &context] { solve(*flags, context); });
}

}  // namespace fathom
