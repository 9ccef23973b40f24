// One estimator's estimate, with what it was made of.

#include "python/src/solution.hpp"

#include <limits>
#include <map>
#include <optional>
#include <pybind11/stl.h>
#include <string>

#include "fathom/harness/run_record.hpp"
#include "fathom/workflow/trajectory_picture.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

// A dict whose missing keys are named with the nearest.
py::object dict_of(const std::map<std::string, double>& metrics) {
  return py::module_::import("fathom._names").attr("Named")("metric", metrics);
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

// As a study stores them.
std::map<std::string, py::array_t<double>> all_series(const Solution& solution) {
  std::map<std::string, py::array_t<double>> arrays;
  for (const auto& [name, values] : run_record(*solution.recording, solution.result, "").series) {
    arrays.emplace(name, array_of(values));
  }
  return arrays;
}

std::string solution_svg(const Solution& solution, const std::string& title) {
  return trajectory_svg(workflow::trajectory_plot(title, *solution.recording, {solution.result}));
}

}  // namespace

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
          "metrics", [](const Solution& s) { return dict_of(s.result.metrics); },
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
          "Of every add_keyframe, ms.")
      .def("_series", &all_series)
      .def("_svg", &solution_svg);
}

}  // namespace fathom
