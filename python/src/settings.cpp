// Configurations: files and dicts, checked by the same code.

#include <pybind11/stl.h>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/workflow/inputs.hpp"
#include "python/src/bindings.hpp"
#include "python/src/shared_estimators.hpp"

namespace fathom {

namespace py = pybind11;

void bind_settings(py::module_& module) {
  py::class_<Settings>(module, "_Settings")
      .def(py::init<>())
      .def_static("read",
                  [](const std::string& path) {
                    // A configuration without a name is none, not an empty one.
                    return path.empty() ? read_settings(path) : workflow::settings_of(path);
                  })
      .def("put_yaml",
           [](Settings& settings, const std::string& yaml, const std::string& source) {
             const Settings given = parse_settings(yaml, source);
             for (const Setting& one : given.all()) settings.put(one);
           })
      .def("drop_below",
           [](Settings& settings, const std::string& prefix) {
             Settings kept;
             for (const Setting& one : settings.all()) {
               if (!one.key.starts_with(prefix)) kept.put(one);
             }
             settings = std::move(kept);
           })
      .def("require_keys", &workflow::require_keys)
      .def("estimator_count",
           [](const Settings& settings) {
             std::size_t count = 0;
             while (!settings.below("estimators." + std::to_string(count) + ".").all().empty()) {
               ++count;
             }
             return count;
           })
      .def(
          "load_plugins",
          [](Settings& settings, const std::vector<std::string>& files) {
            load_plugins(settings, files);
          },
          py::call_guard<py::gil_scoped_release>(), "Loads those that it names, and these.");
}

}  // namespace fathom
