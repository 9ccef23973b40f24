// MeasurementLog, its files and its arrays.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "fathom/report/trajectory_plot.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

void require_usable(const RelativePose& measurement, const char* what) {
  const Eigen::Matrix3d& information = measurement.information;
  const bool is_definite =
      information.allFinite() && Eigen::LLT<Eigen::Matrix3d>(information).info() == Eigen::Success;
  if (is_definite && is_finite(measurement.motion)) return;
  throw InputError(std::string(what) +
                   ": expected a finite motion and a positive definite covariance");
}

void add_keyframe(MeasurementLog& log, const py::object& motion, const py::object& covariance) {
  const std::size_t newest = log.size() - 1;
  const RelativePose step = RelativePose::from_covariance(
      newest, newest + 1, finite_pose_of(motion, "motion"), symmetric_of(covariance, "covariance"));
  require_usable(step, "add_keyframe");
  log.add_keyframe(step);
}

void add_registration(MeasurementLog& log, const RelativePose& registration) {
  require_usable(registration, "add_registration");
  if (registration.from == registration.to || registration.newest() != log.size() - 1) {
    throw InputError("add_registration: one end is the newest keyframe, " +
                     std::to_string(log.size() - 1) + ", the other an earlier one");
  }
  log.add_registration(registration);
}

std::vector<RelativePose> steps_of(const MeasurementLog& log) {
  std::vector<RelativePose> steps;
  for (std::size_t k = 1; k < log.size(); ++k) steps.push_back(log.arrival(k).step);
  return steps;
}

std::vector<RelativePose> registrations_of(const MeasurementLog& log) {
  std::vector<RelativePose> all;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const auto& here = log.arrival(k).registrations;
    all.insert(all.end(), here.begin(), here.end());
  }
  return all;
}

double chi2_of(const MeasurementLog& log, const py::object& trajectory) {
  const std::vector<Pose> poses = poses_of(trajectory, "trajectory");
  if (poses.size() != log.size()) {
    throw InputError(
        fmt::format("trajectory: has {} poses, the log {} keyframes", poses.size(), log.size()));
  }
  return chi2(log, poses);
}

std::string log_svg(const MeasurementLog& log, const std::string& title) {
  TrajectoryPlot plot;
  plot.title = title;
  PlotSeries line{"dead reckoning", dead_reckoning_style(), log.odometry(), {}, {}};
  for (const RelativePose& z : registrations_of(log)) line.loops.emplace_back(z.from, z.to);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      line.absolute.push_back(absolute_mark(z, true));
    }
  }
  plot.series.push_back(std::move(line));
  return trajectory_svg(plot);
}

void bind_files(py::module_& module) {
  module.def(
      "read_g2o",
      [](const py::object& path) {
        const auto file = py::module_::import("os").attr("fspath")(path).cast<std::string>();
        const py::gil_scoped_release unlocked;
        return read_g2o(file);
      },
      py::arg("path"),
      "Reads a 2-D pose graph. Raises InputError with file and line on what cannot be used.");
  module.def(
      "write_g2o",
      [](const MeasurementLog& log, const py::object& path) {
        const auto file = py::module_::import("os").attr("fspath")(path).cast<std::string>();
        const py::gil_scoped_release unlocked;
        write_graph(file, log);
      },
      py::arg("log"), py::arg("path"),
      "Writes a log as g2o, and what its registrations share beside it; it reads back to the same "
      "bits.");
}

}  // namespace

void bind_logs(py::module_& module) {
  py::class_<MeasurementLog>(module, "MeasurementLog",
                             "What every estimator is given, keyframe by keyframe.")
      .def(py::init([](const py::object& start) {
             return MeasurementLog(finite_pose_of(start, "start"));
           }),
           py::arg("start") = py::make_tuple(0.0, 0.0, 0.0),
           "Keyframe 0 alone, held at `start`: x (m), y (m), theta (rad).")
      .def("add_keyframe", &add_keyframe, py::arg("motion"), py::arg("covariance"),
           "Appends a keyframe by its motion from the newest one; 3 x 3 covariance of nu.")
      .def("add_registration", &add_registration, py::arg("registration"),
           "Of the newest keyframe with an earlier one.")
      .def("__len__", &MeasurementLog::size, "Number of keyframes.")
      .def_property_readonly("registration_count", &MeasurementLog::registration_count,
                             "Number of loop closures.")
      .def_property_readonly("steps", &steps_of, "Dead reckoning: N - 1 RelativePose.")
      .def_property_readonly("registrations", &registrations_of,
                             "All RelativePose of loop closures, in order of arrival.")
      .def_property_readonly(
          "dead_reckoning", [](const MeasurementLog& log) { return array_of(log.odometry()); },
          "N x 3: the steps composed.")
      .def("chi2", &chi2_of, py::arg("trajectory"), "F of a trajectory, N x 3; no unit.")
      .def("to_g2o", py::overload_cast<const MeasurementLog&>(&to_g2o),
           py::call_guard<py::gil_scoped_release>(), "The log as text in the g2o format.")
      .def("_svg", &log_svg);
  bind_files(module);
}

}  // namespace fathom
