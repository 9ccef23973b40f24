#include "fathom/core/module.hpp"

#include <dlfcn.h>
#include <system_error>

namespace fathom {

LoadedModule load_module(const ModulePlace& place, const char* symbol, ModuleSymbols symbols) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const int mode = RTLD_NOW | (symbols == ModuleSymbols::kOwn ? RTLD_LOCAL : RTLD_GLOBAL);
  LoadedModule loaded{nullptr, place.built.string() + " is missing", true};
  for (const fs::path& file :
       {program.parent_path() / place.installed / place.built.filename(), place.built}) {
    if (!fs::exists(file, ignored)) continue;
    void* const library = ::dlopen(file.c_str(), mode);
    if (library != nullptr) loaded.symbol = ::dlsym(library, symbol);
    if (loaded.symbol != nullptr) return {loaded.symbol, "", false};
    loaded = {nullptr, ::dlerror(), false};
  }
  return loaded;
}

}  // namespace fathom
