#include "python_plugins.hpp"

#include <dlfcn.h>
#include <string>
#include <system_error>

#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"

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

// The interpreter is in a module of its own: who has no Python needs none. Where it is installed,
// else where it was built.
PythonPlugins* start_python(const std::string& plugin) {
  const fs::path built(FATHOM_PYTHON_MODULE);
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  for (const fs::path& module :
       {program.parent_path() / FATHOM_PYTHON_INSTALLED / built.filename(), built}) {
    if (!fs::exists(module, ignored)) continue;
    // Modules of Python that are loaded later look for its symbols there.
    void* const library = ::dlopen(module.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) throw InputError(plugin, std::string("needs Python: ") + ::dlerror());
    if (void* const symbol = ::dlsym(library, "fathom_python_plugins")) {
      return reinterpret_cast<PythonPlugins*>(symbol);
    }
  }
  throw InputError(plugin, "is written in Python, and " + python_is_missing());
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
