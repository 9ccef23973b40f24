// The estimators that studies and solves find by name: built in, of plug-ins, written in Python.

#include <new>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "apps/estimators.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/estimation/plugin.hpp"
#include "python/src/bindings.hpp"
#include "python/src/python_estimator.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

// Those of the file that was read last: the interface has no other way to tell.
std::vector<EstimatorEntry>& read_last() {
  static std::vector<EstimatorEntry> entries;
  return entries;
}

const PluginInterface* read_python_plugin(const char* file) {
  static const PluginInterface interface {
    kPluginVersion, {}, [](EstimatorRegistry& registry) {
      for (const EstimatorEntry& entry : read_last()) registry.add(entry);
    }
  };
  const py::gil_scoped_acquire lock;
  read_last().clear();
  try {
    const py::object classes = py::module_::import("fathom._estimator").attr("classes_of")(file);
    for (const py::handle one : classes) read_last().push_back(entry_of(one));
  } catch (const py::error_already_set& error) {
    throw InputError(file, text_of(error));
  } catch (const InputError& error) {
    throw InputError(file, error.what());
  }
  if (read_last().empty()) throw InputError(file, "defines no subclass of fathom.Estimator");
  return &interface;
}

// The innermost place, without the folder.
std::string place_of(const py::error_already_set& error) {
  py::object trace = error.trace();
  if (!trace || trace.is_none()) return "";
  while (!trace.attr("tb_next").is_none()) trace = trace.attr("tb_next");
  const std::string file = trace.attr("tb_frame").attr("f_code").attr("co_filename").cast<std::string>();
  return " (" + file.substr(file.rfind('/') + 1) + ":" +
         std::to_string(trace.attr("tb_lineno").cast<int>()) + ")";
}

std::vector<std::string> names_of(const EstimatorRegistry& registry) {
  std::vector<std::string> all;
  for (const EstimatorEntry& entry : registry.entries()) all.push_back(entry.name);
  return all;
}

}  // namespace

std::string text_of(const py::error_already_set& error) {
  if (error.matches(PyExc_MemoryError)) throw std::bad_alloc();
  const std::string type = error.type().attr("__name__").cast<std::string>();
  std::string text = error.value() ? py::str(error.value()).cast<std::string>() : "";
  for (char& letter : text) {
    if (letter == '\n' || letter == '\r') letter = ' ';
  }
  text = type + (text.empty() ? "" : ": " + text) + place_of(error);
  // Last, as it is raised by the next call of Python.
  if (error.matches(PyExc_KeyboardInterrupt)) PyErr_SetInterrupt();
  return text;
}

void bind_estimators(py::module_& module) {
  make_forks_safe();
  set_python_plugins(read_python_plugin);
  // Of another interpreter's host, the program.
  module.attr("_python_plugins") =
      py::capsule(reinterpret_cast<void*>(read_python_plugin), "fathom_python_plugins");
  py::class_<EstimatorRegistry>(module, "_Registry")
      .def(py::init([] { return estimators(); }), "Those known now.")
      .def("names", &names_of)
      .def("add",
           [](EstimatorRegistry& registry, const py::object& estimator_class) {
             EstimatorEntry entry = entry_of(estimator_class);
             std::string name = entry.name;
             registry.add(std::move(entry));
             return name;
           })
      .def("options", [](const EstimatorRegistry& registry, const std::string& name) {
        py::list rows;
        for (const OptionDescription& one : registry.find(name).options) {
          rows.append(py::dict(py::arg("key") = one.key, py::arg("type") = one.type,
                               py::arg("unit") = one.unit, py::arg("default") = one.default_value,
                               py::arg("range") = one.range, py::arg("help") = one.help));
        }
        return rows;
      });
  module.def("_load_plugins", [](const std::vector<std::string>& files) { load_plugins(files); });
  module.def("_hash_of", [](const std::vector<std::string>& files) {
    return fingerprint({files.begin(), files.end()});
  });
}

}  // namespace fathom
