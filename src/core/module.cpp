#include "fathom/core/module.hpp"

#include <dlfcn.h>
#include <system_error>

namespace fathom {

LoadedModule load_module(const ModulePlace& place, const char* symbol, ModuleSymbols symbols) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  const int mode = RTLD_NOW | (symbols == ModuleSymbols::kOwn ? RTLD_LOCAL : RTLD_GLOBAL);
  for (const fs::path& file :
       {(folder / place.installed / place.built.filename()).lexically_normal(), place.built}) {
    if (!fs::exists(file, ignored)) continue;
    void* const library = ::dlopen(file.c_str(), mode);
    void* const found = library == nullptr ? nullptr : ::dlsym(library, symbol);
    if (found != nullptr) return {found, "", false};
    const char* const error = ::dlerror();
    return {nullptr, error == nullptr ? file.string() + " has no " + symbol : error, false};
  }
  return {nullptr, place.built.string() + " is missing", true};
}

}  // namespace fathom
