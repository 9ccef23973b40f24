// Starts a Python interpreter in a program that is none, and has it read plug-ins.

#include <Python.h>
#include <filesystem>
#include <string>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/plugin.hpp"

namespace fathom {
namespace {

constexpr const char* kModule = "fathom._fathom";
constexpr const char* kReader = "fathom_python_plugins";

void require(const PyStatus& status) {
  if (PyStatus_Exception(status) == 0) return;
  throw InputError(std::string("Python does not start: ") +
                   (status.err_msg != nullptr ? status.err_msg : "unknown error"));
}

// Its memory is from malloc, which the program counts; signals stay the program's.
void start_interpreter() {
  PyPreConfig before;
  PyPreConfig_InitPythonConfig(&before);
  before.allocator = PYMEM_ALLOCATOR_MALLOC;
  require(Py_PreInitialize(&before));
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;
  config.buffered_stdio = 0;
  config.parse_argv = 0;
  // Another interpreter on the PATH has another standard library.
  const PyStatus named = PyConfig_SetBytesString(&config, &config.program_name, FATHOM_PYTHON);
  const PyStatus started =
      PyStatus_Exception(named) != 0 ? named : Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  require(started);
  // Without it Python has no table of signals, and an interrupt that is raised reads one.
  PyObject* const signals = PyImport_ImportModule("_signal");
  if (signals == nullptr) PyErr_Clear();
}

std::string error_text() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyObject* const text = value != nullptr ? PyObject_Str(value) : nullptr;
  const char* const bytes = text != nullptr ? PyUnicode_AsUTF8(text) : nullptr;
  return bytes != nullptr ? bytes : "unknown error";
}

// The package as it is installed, else as it was built.
PythonPlugins* import_reader() {
  PyObject* module = PyImport_ImportModule(kModule);
  if (module == nullptr && std::filesystem::is_directory(FATHOM_PYTHON_BUILT)) {
    PyErr_Clear();
    PyObject* const path = PySys_GetObject("path");
    PyObject* const built = PyUnicode_FromString(FATHOM_PYTHON_BUILT);
    if (path != nullptr && built != nullptr) PyList_Append(path, built);
    module = PyImport_ImportModule(kModule);
  }
  PyObject* const capsule =
      module != nullptr ? PyObject_GetAttrString(module, "_python_plugins") : nullptr;
  void* const reader = capsule != nullptr ? PyCapsule_GetPointer(capsule, kReader) : nullptr;
  if (reader == nullptr)
    throw InputError("the Python package fathom cannot be used: " + error_text());
  return reinterpret_cast<PythonPlugins*>(reader);
}

// Started once; the lock is let go, and whoever calls Python takes it.
PythonPlugins* started_reader() {
  static PythonPlugins* const reader = [] {
    start_interpreter();
    PythonPlugins* const found = import_reader();
    PyEval_SaveThread();
    return found;
  }();
  return reader;
}

}  // namespace
}  // namespace fathom

extern "C" __attribute__((visibility("default"))) const fathom::PluginInterface*
fathom_python_plugins(const char* file) {
  return fathom::started_reader()(file);
}
