// MeasurementLog and its files.

#include <string>

#include "fathom/core/files.hpp"
#include "fathom/measurements/g2o.hpp"
#include "python/src/bindings.hpp"

namespace fathom {

namespace py = pybind11;

void bind_logs(py::module_& module) {
  py::class_<MeasurementLog>(module, "MeasurementLog",
                             "What every estimator is given, keyframe by keyframe.")
      .def("__len__", &MeasurementLog::size, "Number of keyframes.")
      .def_property_readonly("registration_count", &MeasurementLog::registration_count,
                             "Number of loop closures.")
      .def("to_g2o", &to_g2o, "The log as text in the g2o format.");
  module.def(
      "read_g2o", [](const std::string& path) { return read_g2o(path); }, py::arg("path"),
      py::call_guard<py::gil_scoped_release>(),
      "Reads a 2-D pose graph. Raises InputError with file and line on what cannot be used.");
  module.def(
      "write_g2o",
      [](const MeasurementLog& log, const std::string& path) { write_file(path, to_g2o(log)); },
      py::arg("log"), py::arg("path"), py::call_guard<py::gil_scoped_release>(),
      "Writes a log as g2o; it reads back to the same bits.");
}

}  // namespace fathom
