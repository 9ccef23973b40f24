// One estimator over one log.

#include "fathom/workflow/solve.hpp"

#include <fmt/format.h>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/measurements/graph_numbers.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/one_thread.hpp"
#include "python/src/solution.hpp"
#include "python/src/work.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

struct HowToSolve {
  std::string mode = "auto";
  std::vector<Pose> start;
  IsolationOptions isolation;
  Settings limits;  ///< what was asked of isolation
};

SolveMode mode_of(const HowToSolve& asked, const EstimatorEntry& entry) {
  if (asked.mode != "auto" && asked.mode != "batch" && asked.mode != "incremental") {
    throw InputError("mode: expected auto, batch or incremental, got '" + asked.mode + "'");
  }
  if (asked.mode == "batch" && !entry.can_batch) {
    throw InputError("mode: " + entry.name + " has no batch mode");
  }
  return workflow::solve_mode(asked.mode == "auto" ? "" : asked.mode, entry);
}

IsolationOptions isolation_of(const Settings& settings) {
  IsolationOptions options;
  OptionTable table;
  options.describe(table);
  for (const Setting& one : settings.all()) table.set(one.key, one.value);
  return options;
}

Solution solve(const MeasurementLog& log, const EstimatorRegistry& registry,
               const std::string& name, const Settings& options, const HowToSolve& asked,
               const py::object& progress) {
  const EstimatorEntry& entry = registry.find(name);
  workflow::SolveRequest request;
  request.mode = mode_of(asked, entry);
  if (request.mode == SolveMode::incremental && !asked.start.empty()) {
    throw InputError("start: an initial guess is for a batch solve");
  }
  if (!asked.start.empty() && asked.start.size() != log.size()) {
    throw InputError(
        fmt::format("start: has {} poses, the log {} keyframes", asked.start.size(), log.size()));
  }
  request.start = asked.start;
  request.isolation = asked.isolation;
  // Inside of a batch solve nothing looks for Ctrl-C.
  if (request.mode == SolveMode::batch && request.isolation.isolation == Isolation::automatic) {
    request.isolation.isolation = Isolation::process;
  }
  if (!request.isolation.is_isolated(entry)) {
    for (const Setting& one : asked.limits.all()) {
      if (one.key != "isolation") throw InputError(workflow::ignored_limit_text(one.key, entry));
    }
  }
  request.estimator = {name, name,
                       estimator_values(options, entry, {log.start(), request.mode}, "")};
  auto recording =
      std::make_shared<const Recording>(workflow::recording_of(log, request.mode, "log"));
  InterruptibleWork work(progress);
  const OneThread pinned;
  Result result = workflow::solve(*recording, request, registry, this_process(), work);
  std::vector<std::string> remarks = graph_remarks(recording->log);
  return {std::move(recording), std::move(result), std::move(remarks)};
}

}  // namespace

void check_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void bind_solve(py::module_& module) {
  module.def("_solve",
             [](const MeasurementLog& log, const EstimatorRegistry& registry,
                const std::string& name, const Settings& options, const std::string& mode,
                const py::object& start, const Settings& isolation, const py::object& progress) {
               HowToSolve how{mode, {}, isolation_of(isolation), isolation};
               if (!start.is_none()) how.start = poses_of(start, "start");
               const py::gil_scoped_release unlocked;
               return solve(log, registry, name, options, how, progress);
             });
}

}  // namespace fathom
