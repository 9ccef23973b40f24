// One estimator over one log.

#include "fathom/workflow/solve.hpp"

#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
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
               const std::string& name, const Settings& options, const HowToSolve& asked) {
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
  request.estimator = {name, name,
                       estimator_values(options, entry, {log.start(), request.mode}, "")};
  auto recording =
      std::make_shared<const Recording>(workflow::recording_of(log, request.mode, "log"));
  InterruptibleWork work;
  const OneThread pinned;
  Result result = workflow::solve(*recording, request, registry, this_process(), work);
  return {std::move(recording), std::move(result)};
}

std::optional<py::array_t<double>> covariances(const Solution& solution) {
  if (!solution.result.run.covariances) return std::nullopt;
  return array_of(*solution.result.run.covariances);
}

std::optional<py::array_t<double>> truth(const Solution& solution) {
  if (!solution.recording->ground_truth) return std::nullopt;
  return array_of(*solution.recording->ground_truth);
}

py::list decisions(const Solution& solution) {
  py::list rows;
  for (const LoopDecision& loop : solution.result.run.loops) {
    rows.append(py::dict(py::arg("from_") = loop.from, py::arg("to") = loop.to,
                         py::arg("fate") = name_of(loop.fate), py::arg("nis") = loop.nis));
  }
  return rows;
}

template <class Field>
auto of_run(Field Run::*field) {
  return [field](const Solution& solution) { return solution.result.run.*field; };
}

template <class Field>
auto cost(Field Costs::*field) {
  return [field](const Solution& solution) { return solution.result.run.costs.*field; };
}

void bind_solution(py::module_& module) {
  py::class_<Solution>(module, "Solution", "One estimator's estimate of a log, and what it cost.")
      .def_property_readonly("estimator", [](const Solution& s) { return s.result.estimator.name; })
      .def_property_readonly(
          "chi2",
          [](const Solution& s) {
            return s.result.metric("chi2").value_or(std::numeric_limits<double>::quiet_NaN());
          },
          "F at the estimate, no unit; NaN where there is none.")
      .def_property_readonly(
          "metrics", [](const Solution& s) { return s.result.metrics; },
          "Every metric that is known, by name (docs/studies.md).")
      .def_property_readonly(
          "trajectory", [](const Solution& s) { return array_of(s.result.run.trajectory); },
          "N x 3: x (m), y (m), theta (rad), world axes.")
      .def_property_readonly("covariances", &covariances, "N x 3 x 3 of the poses, or None.")
      .def_property_readonly("ground_truth", &truth, "N x 3 of the keyframes, or None.")
      .def_property_readonly(
          "times_ns", [](const Solution& s) { return array_of(s.recording->keyframe_times_ns); },
          "(N,) of the keyframes, int64 nanoseconds.")
      .def_property_readonly(
          "log", [](const Solution& s) { return s.recording->log; },
          "What the estimator was given.")
      .def_property_readonly("loops", &decisions,
                             "The decision on every registration: from_, to, fate, nis.")
      .def_property_readonly(
          "outcome", [](const Solution& s) { return name_of(s.result.run.outcome); },
          "How it ended: 'converged', ...")
      .def_property_readonly(
          "is_done", [](const Solution& s) { return s.result.is_done(); },
          "Whether the estimate can be used.")
      .def_property_readonly("fault", of_run(&Run::fault),
                             "How the estimator broke its contract or its process ended, or ''.")
      .def_readonly("remarks", &Solution::remarks, "What looks wrong with it, sentences.")
      .def_property_readonly("iterations", of_run(&Run::iterations))
      .def_property_readonly("total_ms", cost(&Costs::total_ms),
                             "Wall time of the estimator's calls, covariances apart, ms.")
      .def_property_readonly("cpu_ms", cost(&Costs::cpu_ms), "Processor time of these, ms.")
      .def_property_readonly(
          "update_ms", [](const Solution& s) { return array_of(s.result.run.costs.update_ms); },
          "Of every update, or of the batch solve, ms.")
      .def_property_readonly(
          "add_ms", [](const Solution& s) { return array_of(s.result.run.costs.add_ms); },
          "Of every add_keyframe, ms.");
}

}  // namespace

void check_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void bind_solve(py::module_& module) {
  bind_solution(module);
  module.def("_solve", [](const MeasurementLog& log, const EstimatorRegistry& registry,
                          const std::string& name, const Settings& options, const std::string& mode,
                          const py::object& start, const Settings& isolation) {
    HowToSolve how{mode, {}, isolation_of(isolation)};
    if (!start.is_none()) how.start = poses_of(start, "start");
    const py::gil_scoped_release unlocked;
    return solve(log, registry, name, options, how);
  });
}

}  // namespace fathom
