#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/configuration/isolation.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// How a log is solved.
struct SolveRequest {
  EstimatorConfiguration estimator;
  SolveMode mode = SolveMode::batch;
  /// Of a batch solve, a pose a keyframe; empty: the estimator's own.
  std::vector<Pose> start;
  IsolationOptions isolation;
};

/// The mode that is asked for, "batch" or "incremental"; of an empty word batch where the estimator
/// can. Throws InputError where it cannot.
SolveMode solve_mode(const std::string& word, const EstimatorEntry& entry);

/// Why a limit of a process is refused where the estimator has none of its own.
std::string ignored_limit_text(const std::string& key, const EstimatorEntry& entry);

/// A log of another source as a recording: keyframes are a second apart. Keyframe by keyframe it
/// needs a start, which its priors give; `source` names it in errors. Throws InputError.
Recording recording_of(MeasurementLog log, SolveMode mode, const std::string& source);

/// Gives the log to the estimator and judges it. Throws InputError.
Result solve(const Recording& recording, const SolveRequest& request,
             const EstimatorRegistry& registry, const Machine& machine, Observer& observer);

/// A pose graph from a file, as `fathom solve` has it.
struct SolveGraphRequest {
  std::filesystem::path graph;
  Settings settings;  ///< `estimator.…`, `dataset.…` of a graph, `seed`, isolation, `plugins`
  std::string estimator;               ///< in place of estimator.type; empty: ceres_pose_graph
  std::string mode;                    ///< as in solve_mode
  bool starts_from_file = false;       ///< a batch solve starts at the graph's vertices
  std::filesystem::path ground_truth;  ///< true poses (TUM, vertex ids as stamps), or empty
  std::filesystem::path false_loops;   ///< as `spoil` wrote it, or empty
  std::optional<int> component;        ///< of a graph that falls into several
  bool drop_self_edges = false;        ///< as GraphOptions
  std::filesystem::path out;           ///< empty: `runs/` and the names of graph and estimator
  std::string made_by;                 ///< the command line, for run.json
};

struct SolveOutcome {
  Recording recording;
  Result result;
};

/// Solves it and writes the folder of the run. Throws InputError.
SolveOutcome solve_graph(const SolveGraphRequest& request, const EstimatorRegistry& registry,
                         const Machine& machine, Observer& observer);

}  // namespace fathom::workflow
