#include "fathom/workflow/solve.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fathom/core/files.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/map_fit.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/measurements/graph_numbers.hpp"
#include "fathom/workflow/inputs.hpp"
#include "fathom/workflow/trajectory_picture.hpp"
#include "graph_keys.hpp"
#include "study_files.hpp"

namespace fathom::workflow {
namespace {

bool is_of_solve(const std::string& key) {
  return key == "plugins" || is_isolation_key(key) || key.starts_with("estimator.") ||
         is_graph_key(key);
}

[[noreturn]] void refuse_unknown(const Setting& setting, const EstimatorEntry& entry) {
  std::vector<std::string> known{"seed", "estimator.type"};
  for (const OptionDescription& option : entry.options) known.push_back("estimator." + option.key);
  std::ranges::copy(graph_keys(), std::back_inserter(known));
  refuse(setting, "unknown key '" + setting.key + "'" + suggestion(setting.key, known) +
                      " ('solve' takes estimator.…, seed, and of dataset.… what a graph has)");
}

// The estimator that the settings and the request name; other settings than those of a solve are
// refused.
const EstimatorEntry& entry_of(const SolveGraphRequest& request,
                               const EstimatorRegistry& registry) {
  std::string type = request.estimator;
  const Setting* other = nullptr;
  for (const Setting& setting : request.settings.all()) {
    if (setting.key == "estimator.type") {
      if (!request.estimator.empty()) refuse(setting, "--estimator says it already");
      type = word_of(setting, setting.key);
    } else if (setting.key == "seed") {
      // Nothing here is random; it is checked as everywhere.
      Settings seed;
      seed.put(setting);
      configure(seed, ConfigurationKind::single, registry);
    } else if (!is_of_solve(setting.key)) {
      other = &setting;
    }
  }
  const EstimatorEntry& entry = registry.find(type.empty() ? "ceres_pose_graph" : type);
  if (other != nullptr) refuse_unknown(*other, entry);
  return entry;
}

// A start from the file is for a batch solve that makes none of its own.
void check_start(const SolveGraphRequest& request, SolveMode mode) {
  if (!request.starts_from_file) return;
  if (mode == SolveMode::incremental) {
    throw InputError("--init file: only a batch solve has a start; use --mode batch");
  }
  const Setting* start = request.settings.find("estimator.start");
  if (start == nullptr) return;
  const std::string& word = word_of(*start, "estimator.start");
  if (word != "auto" && word != "given") {
    refuse(*start,
           "estimator.start: " + word + " makes a start of its own and would ignore --init file");
  }
}

EstimatorConfiguration configured(const SolveGraphRequest& request, const EstimatorEntry& entry,
                                  SolveMode mode) {
  Settings own;
  const Settings given = request.settings.below("estimator.");
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
    refuse(setting, ignored_limit_text(setting.key, entry));
  }
  return options;
}

// What the request names, read.
Recording read(const SolveGraphRequest& request, const GraphOptions& graph, SolveMode mode) {
  Recording recording = record_graph(request.graph, graph);
  // Keyframe by keyframe needs a start; one solve takes it from all that there is.
  if (mode == SolveMode::incremental) {
    recording.log = with_start_of_priors(recording.log, request.graph.string());
  }
  if (!request.ground_truth.empty()) attach_ground_truth(recording, request.ground_truth);
  if (!request.false_loops.empty()) {
    recording.is_false_loop = read_false_loops(request.false_loops, recording.log);
  }
  return recording;
}

std::string manifest_of(const SolveGraphRequest& request, const GraphOptions& graph,
                        const SolveOutcome& done, const EstimatorRegistry& registry,
                        const std::vector<std::string>& remarks) {
  std::vector<std::pair<std::string, std::string>> configuration{
      {"graph", request.graph.string()}, {"init", request.starts_from_file ? "file" : "odometry"}};
  std::ranges::copy(in_force(graph, done.recording.log), std::back_inserter(configuration));
  return manifest_json(request.made_by, configuration,
                       with_code(fingerprint({request.graph}), {done.result.estimator}, registry),
                       done.recording, done.result, registry, remarks);
}

// What of the map looks wrong. Where it ended counts as the optimum until something may be wrong
// with it: batch solves by all that can take longer than the one that was asked for.
std::vector<std::string> solve_remarks(const SolveOutcome& done,
                                       const EstimatorRegistry& registry) {
  constexpr std::size_t kMostKeyframes = 20'000;
  const MeasurementLog& log = done.recording.log;
  const Result& result = done.result;
  const Run& run = result.run;
  std::vector<std::string> remarks = graph_remarks(log);
  if (!result.is_done() || run.trajectory.size() != log.size()) return remarks;
  BatchOptimum optimum{
      run.trajectory, chi2(log, run.trajectory, run.errors), result.estimator.type, {}, run.errors};
  auto fit = map_fit(log, run.trajectory, optimum, &run);
  if (!fit) return remarks;
  MapFit least = *fit;
  least.chi2_optimum = 0.0;
  least.chi2_alone = 0.0;
  const bool may_be_off = result.mode == SolveMode::incremental && !least.estimate_fits();
  if (!fit->measurements_disagree() && !may_be_off) return remarks;
  if (log.size() <= kMostKeyframes) {
    const auto found = batch_optimum(log, registry, {}, run.errors);
    if (!found) return remarks;
    if (found->chi2 < optimum.chi2) optimum = *found;
    fit = map_fit(log, run.trajectory, optimum, &run);
  } else if (result.mode != SolveMode::batch || fit->leaves_out_most()) {
    return remarks;
  }
  fit->considers_shared_errors =
      takes_shared_errors_as("consider", log, result.estimator, registry);
  std::ranges::copy(map_remarks(*fit, result.estimator.name, optimum.solver),
                    std::back_inserter(remarks));
  return remarks;
}

}  // namespace

SolveMode solve_mode(const std::string& word, const EstimatorEntry& entry) {
  if (word == "incremental" || (word.empty() && !entry.can_batch)) return SolveMode::incremental;
  if (!entry.can_batch) {
    throw InputError("--mode batch: " + entry.name +
                     " takes a log in its order, keyframe by keyframe; use --mode incremental");
  }
  return SolveMode::batch;
}

Recording recording_of(MeasurementLog log, SolveMode mode, const std::string& source) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  Recording recording;
  recording.log = mode == SolveMode::batch ? std::move(log) : with_start_of_priors(log, source);
  recording.keyframe_times_ns.reserve(recording.log.size());
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * kSecond);
  }
  return recording;
}

Result solve(const Recording& recording, const SolveRequest& request,
             const EstimatorRegistry& registry, const Machine& machine, Observer& observer) {
  const auto meter = machine.make_meter ? machine.make_meter() : nullptr;
  EvaluationOptions options;
  options.mode = request.mode;
  options.start = request.start;
  options.isolation = request.isolation;
  options.memory = meter.get();
  options.progress = observer.progress_of(request.estimator.type + ", keyframe");
  return evaluate(recording, request.estimator, registry, {}, options);
}

std::string ignored_limit_text(const std::string& key, const EstimatorEntry& entry) {
  return key + ": " + entry.name +
         " runs in no process of its own, and it would be ignored; isolation: process gives it one";
}

SolveOutcome solve_graph(const SolveGraphRequest& request, const EstimatorRegistry& registry,
                         const Machine& machine, Observer& observer) {
  const EstimatorEntry& entry = entry_of(request, registry);
  SolveRequest asked;
  asked.mode = solve_mode(request.mode, entry);
  check_start(request, asked.mode);
  asked.estimator = configured(request, entry, asked.mode);
  const GraphOptions graph =
      graph_options(request.settings, request.component, request.drop_self_edges);
  Recording recording = read(request, graph, asked.mode);
  asked.isolation = isolation_of(request.settings, entry);
  if (request.starts_from_file) {
    if (!recording.log.guess) {
      throw InputError(request.graph.string(),
                       "has no vertices to start from; use --init odometry");
    }
    asked.start = *recording.log.guess;
  }
  const std::string name = stem_of(request.graph);
  const std::filesystem::path out =
      request.out.empty() ? std::filesystem::path("runs") / (name + "-" + entry.name) : request.out;
  require_no_study(out);
  StagedFolder folder(out, {request.graph, request.ground_truth, request.false_loops});
  SolveOutcome done{std::move(recording), {}};
  done.result = solve(done.recording, asked, registry, machine, observer);
  const std::vector<std::string> remarks = solve_remarks(done, registry);
  write_run(folder.path(), done.recording, done.result,
            manifest_of(request, graph, done, registry, remarks));
  write_trajectory_picture(folder.path() / "trajectory.png", name + ", " + entry.name,
                           done.recording, {done.result});
  folder.commit(optional_run_files());
  observer.wrote((folder.target() / "trajectory.png").string());
  for (const std::string& remark : remarks) observer.remark(remark);
  return done;
}

}  // namespace fathom::workflow
