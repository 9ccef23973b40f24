// One estimator over one log.

#include <cstdint>
#include <limits>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/harness/result.hpp"
#include "python/src/bindings.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

struct Solution {
  Replay replay;
  double chi2 = 0.0;
};

std::string word_of_value(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  return py::str(value).cast<std::string>();
}

OptionValue option_value(const py::handle& value) {
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value)) {
    return OptionValue::scalar(word_of_value(value));
  }
  OptionValue list{{}, true};
  for (const py::handle item : value) list.items.push_back(word_of_value(item));
  return list;
}

Settings settings_of(const py::kwargs& options) {
  Settings settings;
  for (const auto& [key, value] : options) {
    const std::string name = py::str(key).cast<std::string>();
    settings.put({name, option_value(value), "solve(" + name + "=...)"});
  }
  return settings;
}

// Ctrl-C ends a replay at its next keyframe.
void check_signals(std::size_t, std::size_t) {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

Solution solve(const MeasurementLog& log, const std::string& name, const py::kwargs& options) {
  const EstimatorEntry& entry = builtin_estimators().find(name);
  ReplayOptions how;
  how.mode = entry.can_batch ? SolveMode::batch : SolveMode::incremental;
  how.progress = check_signals;
  const EstimatorValues values =
      estimator_values(settings_of(options), entry, {log.start(), how.mode}, "");
  const py::gil_scoped_release unlocked;
  Recording recording;
  recording.log = how.mode == SolveMode::batch ? log : with_start_of_priors(log, "log");
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * kSecond);
  }
  Result result = evaluate(recording, {name, name, values}, builtin_estimators(), {}, how);
  const double chi2 = result.metric("chi2").value_or(std::numeric_limits<double>::quiet_NaN());
  return {std::move(result.replay), chi2};
}

py::array_t<double> trajectory(const Solution& solution) {
  const std::vector<Pose>& poses = solution.replay.trajectory;
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{3}});
  auto rows = array.mutable_unchecked<2>();
  for (py::ssize_t k = 0; k < rows.shape(0); ++k) {
    const Eigen::Vector3d pose = poses[static_cast<std::size_t>(k)].vector();
    for (py::ssize_t i = 0; i < 3; ++i) rows(k, i) = pose(i);
  }
  return array;
}

std::optional<py::array_t<double>> covariances(const Solution& solution) {
  if (!solution.replay.covariances) return std::nullopt;
  const auto& all = *solution.replay.covariances;
  py::array_t<double> array({static_cast<py::ssize_t>(all.size()), py::ssize_t{3}, py::ssize_t{3}});
  auto blocks = array.mutable_unchecked<3>();
  for (py::ssize_t k = 0; k < blocks.shape(0); ++k) {
    for (py::ssize_t i = 0; i < 3; ++i) {
      for (py::ssize_t j = 0; j < 3; ++j) blocks(k, i, j) = all[static_cast<std::size_t>(k)](i, j);
    }
  }
  return array;
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) all.push_back(entry.name);
  return all;
}

}  // namespace

void bind_solve(py::module_& module) {
  py::class_<Solution>(module, "Solution", "One estimator's estimate of a log, and what it cost.")
      .def_readonly("chi2", &Solution::chi2, "F at the estimate, no unit.")
      .def_property_readonly("trajectory", &trajectory, "N x 3: x (m), y (m), theta (rad).")
      .def_property_readonly("covariances", &covariances, "N x 3 x 3 of the poses, or None.")
      .def_property_readonly(
          "outcome", [](const Solution& s) { return name_of(s.replay.outcome); },
          "How it ended: 'converged', ...")
      .def_property_readonly("iterations", [](const Solution& s) { return s.replay.iterations; })
      .def_property_readonly(
          "total_ms", [](const Solution& s) { return s.replay.total_ms; }, "Wall time, ms.");
  module.def("estimators", &names, "Names of the estimators.");
  module.def("solve", &solve, py::arg("log"), py::arg("estimator") = "sparse_gauss_newton",
             "Solves a log; options are the estimator's own.");
}

}  // namespace fathom
