// The estimators that studies and solves find by name: built in, of plug-ins, written in Python.

#include <fmt/format.h>
#include <new>
#include <pybind11/stl.h>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/plugin.hpp"
#include "python/src/bindings.hpp"
#include "python/src/python_estimator.hpp"
#include "python/src/shared_estimators.hpp"

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

// The innermost place outside of installed packages, without the folder: a line of the estimator's,
// not of what it calls.
std::string place_of(const py::error_already_set& error) {
  std::string place;
  bool is_own = false;
  for (py::object trace = error.trace(); trace && !trace.is_none(); trace = trace.attr("tb_next")) {
    const auto file = trace.attr("tb_frame").attr("f_code").attr("co_filename").cast<std::string>();
    const bool is_here = file.find("-packages/") == std::string::npos && !file.starts_with('<');
    if (is_own && !is_here) continue;
    is_own = is_here;
    place = fmt::format(" ({}:{})", file.substr(file.rfind('/') + 1),
                        trace.attr("tb_lineno").cast<int>());
  }
  return place;
}

// What an exception says of itself, if it can.
std::string message_of(const py::object& value) {
  if (!value) return "";
  try {
    return py::str(value).attr("encode")("utf-8", "backslashreplace").cast<std::string>();
  } catch (const py::error_already_set&) {
    return "its text cannot be had";
  }
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
  std::string text = message_of(error.value());
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
      .def(py::init([] {
             const py::gil_scoped_release unlocked;
             return known_estimators_now();
           }),
           "Those known now.")
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
  // Without the interpreter's lock, which a plug-in in Python takes on whatever thread reads it.
  module.def(
      "_load_plugins", [](const std::vector<std::string>& files) { load_plugins(files); },
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace fathom
