// Registration of two pictures.

#include "fathom/vision/registration.hpp"

#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <optional>
#include <pybind11/stl.h>
#include <string>

#include "fathom/configuration/config_file.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/camera_options.hpp"
#include "fathom/front_end/options.hpp"
#include "fathom/front_end/pair_seed.hpp"
#include "python/src/arrays.hpp"
#include "python/src/bindings.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

using Picture = py::array_t<std::uint8_t, py::array::c_style>;

template <class Options>
Options set_options(Options options, const Settings& settings) {
  OptionTable table;
  options.describe(table);
  for (const Setting& one : settings.all()) {
    try {
      table.set(one.key, one.value);
    } catch (const InputError& error) {
      refuse(one, error.what());
    }
  }
  return options;
}

// Shares the memory of the array, which stays unchanged.
cv::Mat grey(const py::array& array, const CameraModel& camera, const std::string& what) {
  if (!Picture::check_(array) || array.ndim() != 2) {
    throw InputError(what + ": expected a grey picture, a contiguous array of uint8 with 2 axes");
  }
  if (array.shape(0) != camera.height || array.shape(1) != camera.width) {
    throw InputError(fmt::format("{}: is {} x {} pixels, the camera {} x {}", what, array.shape(1),
                                 array.shape(0), camera.width, camera.height));
  }
  return {static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), CV_8UC1,
          const_cast<void*>(array.data())};  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

struct View {
  cv::Mat picture;
  double altitude_m = 0.0;
  std::optional<MeasuredTilt> tilt;
};

std::optional<MeasuredTilt> tilt_of(const py::object& given, const std::string& what) {
  if (given.is_none()) return std::nullopt;
  const Array values = checked_array(given, {3}, what);
  const double* const tilt = values.data();
  if (!std::isfinite(tilt[0]) || !std::isfinite(tilt[1]) || !std::isfinite(tilt[2]) ||
      tilt[2] < 0.0) {
    throw InputError(what + ": expected finite roll and pitch and a sigma of at least 0, rad");
  }
  return MeasuredTilt{{tilt[0], tilt[1]}, tilt[2]};
}

Registration registration_of(const View& a, const View& b, const Camera& camera,
                             const FrontEndOptions& options, std::uint64_t seed) {
  const RegistrationOptions& registration = options.registration;
  const FeatureExtractor extractor(options.features, registration.tuning.features);
  const auto features = [&](const View& view) {
    return on_floor(extractor.extract(view.picture), camera, view.altitude_m, view.tilt);
  };
  return register_pair(features(a), features(b), registration, pair_seed(seed, 0, 1));
}

template <class Value>
py::object if_found(const Registration& registration, const Value& value) {
  return registration.found ? py::object(array_of(value)) : py::object(py::none());
}

void bind_result(py::module_& module) {
  py::class_<Registration>(module, "Registration",
                           "The motion between two pictures, or why there is none.")
      .def_readonly("found", &Registration::found)
      .def("__bool__", [](const Registration& r) { return r.found; })
      .def_property_readonly(
          "motion", [](const Registration& r) { return if_found(r, r.motion); },
          "(3,): the pose of the second in the frame of the first, m and rad; None of not found.")
      .def_property_readonly(
          "covariance", [](const Registration& r) { return if_found(r, r.covariance); },
          "3 x 3 of (x, y, theta), axes of the first; None of not found.")
      .def_property_readonly(
          "inliers", [](const Registration& r) { return r.inliers.size(); },
          "Matches that agree with the motion.")
      .def_property_readonly(
          "putative", [](const Registration& r) { return r.putative.size(); },
          "Matches that were tried.")
      .def_readonly("rms_m", &Registration::rms_m, "Of the inliers' errors.")
      .def_property_readonly(
          "false_alarms", [](const Registration& r) { return r.evidence.false_alarms; },
          "The probability of a false alarm.")
      .def_readonly("reason", &Registration::reason, "Of not found.");
}

}  // namespace

void bind_registration(py::module_& module) {
  bind_result(module);
  module.def(
      "_register", [](const py::array& a, const py::array& b, double altitude_a, double altitude_b,
                      const Settings& camera_settings, const Settings& front_end_settings,
                      const py::object& tilt_a, const py::object& tilt_b, std::uint64_t seed) {
        const Camera camera(set_options(CameraOptions{}, camera_settings).model("camera."));
        const FrontEndOptions options = set_options(FrontEndOptions{}, front_end_settings);
        const View view_a{grey(a, camera.model(), "a"), altitude_a, tilt_of(tilt_a, "tilt_a")};
        const View view_b{grey(b, camera.model(), "b"), altitude_b, tilt_of(tilt_b, "tilt_b")};
        const py::gil_scoped_release unlocked;
        return registration_of(view_a, view_b, camera, options, seed);
      });
}

}  // namespace fathom
