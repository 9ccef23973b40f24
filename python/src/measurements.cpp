// What an estimator in Python is given.

#include <pybind11/stl.h>
#include <vector>

#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/registry.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/given_measurements.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

void bind_relative(py::module_& module) {
  py::class_<RelativePose>(
      module, "RelativePose",
      "A measured motion between two keyframes: the pose of `to` in the frame of `from_`.")
      .def(py::init([](std::size_t from, std::size_t to, const py::object& motion,
                       const py::object& covariance) {
             return RelativePose::from_covariance(from, to, finite_pose_of(motion, "motion"),
                                                  symmetric_of(covariance, "covariance"));
           }),
           py::arg("from_"), py::arg("to"), py::arg("motion"), py::arg("covariance"),
           "`covariance`: 3 x 3 of nu = z - h(x), in the frame of `from_`, positive definite.")
      .def_readonly("from_", &RelativePose::from, "Keyframe index.")
      .def_readonly("to", &RelativePose::to, "Keyframe index.")
      .def_property_readonly(
          "motion", [](const RelativePose& z) { return array_of(z.motion); },
          "(3,): x, y (m), theta (rad).")
      .def_property_readonly(
          "information", [](const RelativePose& z) { return array_of(z.information); },
          "3 x 3, of the residual t2v(Z^-1 A^-1 B), in the frame of `to` as measured.")
      .def_property_readonly(
          "covariance", [](const RelativePose& z) { return array_of(z.covariance()); },
          "3 x 3 of nu = z - h(x), in the frame of `from_`.")
      .def_readonly("inliers", &RelativePose::inliers, "Matches that support it, or None.")
      .def_readonly("is_hole", &RelativePose::is_hole,
                    "Of a step: nothing was measured, `motion` is a guess.")
      .def("reversed", &RelativePose::reversed, "The same measurement from its other end.")
      .def("forward", &RelativePose::forward, "The same measurement with from_ < to.");
}

void bind_absolute(py::module_& module) {
  py::class_<AbsolutePose>(module, "AbsolutePose",
                           "A measurement of a keyframe's pose in the world: heading, fix or both.")
      .def_readonly("keyframe", &AbsolutePose::keyframe)
      .def_property_readonly(
          "pose", [](const AbsolutePose& z) { return array_of(z.pose); },
          "(3,): x, y (m), theta (rad), world axes.")
      .def_property_readonly(
          "information", [](const AbsolutePose& z) { return array_of(z.information); },
          "3 x 3, positive semi-definite, of t2v(A^-1 X), in the axes of A.");
}

}  // namespace

void bind_measurements(py::module_& module) {
  bind_relative(module);
  bind_absolute(module);
  py::class_<GivenMeasurements>(module, "Measurements", "What is measured of the newest keyframe.")
      .def_readonly("registrations", &GivenMeasurements::registrations,
                    "List of RelativePose; either end may be the newest keyframe.")
      .def_readonly("absolute", &GivenMeasurements::absolute, "List of AbsolutePose.");
  py::class_<EstimatorSetup>(module, "Setup", "What an estimator is told beside its options.")
      .def_property_readonly(
          "start", [](const EstimatorSetup& setup) { return array_of(setup.start.pose); },
          "(3,): where keyframe 0 is, world axes.")
      .def_property_readonly(
          "start_covariance",
          [](const EstimatorSetup& setup) { return array_of(setup.start.covariance); },
          "3 x 3, world axes; zero: keyframe 0 is held at `start`.")
      .def_property_readonly("start_is_fixed",
                             [](const EstimatorSetup& setup) { return setup.start.is_fixed(); })
      .def_property_readonly(
          "start_is_free", [](const EstimatorSetup& setup) { return setup.start.is_free; },
          "Nothing is known of keyframe 0 but what absolute measurements say.")
      .def_property_readonly(
          "mode",
          [](const EstimatorSetup& setup) {
            return setup.mode == SolveMode::batch ? "batch" : "incremental";
          },
          "'incremental': an estimate after every keyframe; 'batch': one solve, in finish().");
}

}  // namespace fathom
