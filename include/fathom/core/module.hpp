#pragma once

#include <filesystem>
#include <string>

namespace fathom {

/// Code of the program in a file of its own, loaded when it is needed (cmake/FathomModule.cmake).
struct ModulePlace {
  std::filesystem::path built;      ///< the file in the build folder, or as installed
  std::filesystem::path installed;  ///< folder, relative to that of the program
};

enum class ModuleSymbols {
  kOwn,     ///< nobody else finds them
  kForAll,  ///< what is loaded later looks for them there
};

struct LoadedModule {
  void* symbol = nullptr;  ///< nothing where `problem` says why
  std::string problem;
  bool is_missing = false;  ///< the file is at neither place
};

/// The symbol of a module, from where it is installed, else, where nothing is, from where it was
/// built. It stays loaded.
LoadedModule load_module(const ModulePlace& place, const char* symbol,
                         ModuleSymbols symbols = ModuleSymbols::kOwn);

}  // namespace fathom
