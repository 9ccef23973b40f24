// What an estimator in Python is given.

#include <memory>
#include <optional>
#include <pybind11/stl.h>
#include <vector>

#include <Eigen/Cholesky>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/geometry/covariance.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"
#include "python/src/given_measurements.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

PictureErrors picture_errors(const py::object& G, const py::object& sigma) {
  const std::vector<double> sigmas = values_of(sigma, "sigma");
  if (sigmas.size() != 3) throw InputError("sigma: expected shape (3,)");
  PictureErrors errors{matrix_of(G, "G"), Eigen::Vector3d(sigmas[0], sigmas[1], sigmas[2])};
  if (!errors.G.allFinite()) throw InputError("G: expected finite numbers");
  if (!errors.sigma.allFinite() || errors.sigma.minCoeff() < 0.0) {
    throw InputError("sigma: expected finite standard deviations, 0 or above");
  }
  return errors;
}

void bind_shared(py::module_& module) {
  py::class_<PictureErrors>(
      module, "PictureErrors",
      "What the errors n of one picture do to a registration of it: z moves by G n.")
      .def(py::init(&picture_errors), py::arg("G"), py::arg("sigma"))
      .def_property_readonly(
          "G", [](const PictureErrors& errors) { return array_of(errors.G); },
          "3 x 3, in the frame of `from_`; columns: altitude (m), roll, pitch (rad).")
      .def_property_readonly(
          "sigma",
          [](const PictureErrors& errors) {
            return array_of(std::vector<double>(errors.sigma.begin(), errors.sigma.end()));
          },
          "(3,): standard deviations of n, whose parts are independent, of zero mean.");
  py::class_<SharedErrors>(
      module, "SharedErrors",
      "A registration's errors apart: nu = G_from n_from + G_to n_to + its own. n of a picture is "
      "the same in all its registrations.")
      .def(py::init([](const PictureErrors& from, const PictureErrors& to, const py::object& own) {
             SharedErrors errors{from, to, symmetric_of(own, "own")};
             if (Eigen::LLT<Eigen::Matrix3d>(errors.own).info() != Eigen::Success) {
               throw InputError("own: expected a positive definite covariance");
             }
             return errors;
           }),
           py::arg("from_"), py::arg("to"), py::arg("own"))
      .def_readonly("from_", &SharedErrors::from, "PictureErrors of `from_`.")
      .def_readonly("to", &SharedErrors::to, "PictureErrors of `to`.")
      .def_property_readonly(
          "own", [](const SharedErrors& errors) { return array_of(errors.own); },
          "3 x 3 covariance of what is its own, in the frame of `from_`.")
      .def_property_readonly(
          "total", [](const SharedErrors& errors) { return array_of(errors.total()); },
          "3 x 3: the covariance of the registration alone.");
}

void bind_relative(py::module_& module) {
  py::class_<RelativePose>(
      module, "RelativePose",
      "A measured motion between two keyframes: the pose of `to` in the frame of `from_`.")
      .def(py::init([](std::size_t from, std::size_t to, const py::object& motion,
                       const py::object& covariance) {
             const Eigen::Matrix3d given = symmetric_of(covariance, "covariance");
             if (!is_positive_definite(given)) {
               throw InputError("covariance: expected a positive definite matrix");
             }
             return RelativePose::from_covariance(from, to, finite_pose_of(motion, "motion"),
                                                  given);
           }),
           py::arg("from_"), py::arg("to"), py::arg("motion"), py::arg("covariance"),
           "`covariance`: 3 x 3 of nu = z - h(x), in the frame of `from_`, positive definite.")
      .def(py::init([](std::size_t from, std::size_t to, const py::object& motion,
                       const SharedErrors& shared) {
             RelativePose z = RelativePose::from_covariance(
                 from, to, finite_pose_of(motion, "motion"), shared.total());
             z.shared = std::make_shared<const SharedErrors>(shared);
             return z;
           }),
           py::arg("from_"), py::arg("to"), py::arg("motion"), py::kw_only(), py::arg("shared"),
           "A registration that tells its errors apart; its covariance is their total.")
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
      .def_readonly("repeats", &RelativePose::repeats,
                    "Its own covariance stands so many times for what it is alone, as other "
                    "registrations have keypoints in common with it.")
      .def("alone", &RelativePose::alone,
           "With the covariance that it has alone: what its error is judged by.")
      .def_property_readonly(
          "shared",
          [](const RelativePose& z) {
            return z.shared ? std::optional<SharedErrors>(*z.shared) : std::nullopt;
          },
          "SharedErrors where the registration tells its errors apart, else None.")
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
  bind_shared(module);
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
