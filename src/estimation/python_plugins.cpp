#include "python_plugins.hpp"

#include <string>

#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/module.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

PythonPlugins* python_plugins = nullptr;

std::string python_is_missing() {
  const Feature& python = feature("python");
  if (!python.is_built) return refusal_without(python.name);
  return "its module is not there; install the package python3-fathom, or '" + remedy_for(python) +
         "' builds it again";
}

// The interpreter is in a module of its own: who has no Python needs none. Modules of Python that
// are loaded later look for its symbols there.
PythonPlugins* start_python(const std::string& plugin) {
  const ModulePlace place{FATHOM_MODULE_BUILT, FATHOM_MODULE_INSTALLED};
  const LoadedModule module = load_module(place, "fathom_python_plugins", ModuleSymbols::kForAll);
  if (module.symbol != nullptr) return reinterpret_cast<PythonPlugins*>(module.symbol);
  if (module.is_missing) {
    throw InputError(plugin, "is written in Python, and " + python_is_missing());
  }
  throw InputError(plugin, "needs Python: " + module.problem);
}

}  // namespace

void set_python_plugins(PythonPlugins* plugins) {
  python_plugins = plugins;
}

const PluginInterface& python_interface_of(const fs::path& file) {
  if (!fs::is_regular_file(file)) {
    throw InputError("'" + file.string() + "': there is no such plug-in");
  }
  if (python_plugins == nullptr) python_plugins = start_python(file.string());
  return *python_plugins(fs::absolute(file).c_str());
}

}  // namespace fathom
