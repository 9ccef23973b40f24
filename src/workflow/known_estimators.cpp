#include "fathom/workflow/known_estimators.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/plugin.hpp"
#include "fathom/workflow/named_code.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSearchPath = "FATHOM_PLUGIN_PATH";

// A folder stands for the shared objects in it, in the order of their names.
std::vector<fs::path> shared_objects_of(const fs::path& place) {
  if (!fs::is_directory(place)) return {place};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(place)) {
    if (entry.path().extension() == ".so") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void KnownEstimators::load(const fs::path& file) {
  const fs::path known_as = fs::weakly_canonical(file);
  const auto loaded = loaded_.find(known_as);
  if (loaded == loaded_.end()) {
    load_plugin(file, registry_);
    loaded_[known_as] = fingerprint({known_as});
  } else if (loaded->second != fingerprint({known_as})) {
    throw InputError(file.string(), "has changed since it was loaded; start the program again");
  }
}

std::vector<std::string> KnownEstimators::load_search_path() {
  const char* const places = std::getenv(kSearchPath);
  std::vector<std::string> left_out;
  std::istringstream words(places == nullptr ? "" : places);
  for (std::string place; std::getline(words, place, ':');) {
    if (place.empty()) continue;
    for (const fs::path& file : shared_objects_of(place)) {
      try {
        load(file);
      } catch (const InputError& error) {
        left_out.push_back(std::string(kSearchPath) + ": left out: " + error.what());
      }
    }
  }
  return left_out;
}

void KnownEstimators::load(Settings& settings, const std::vector<std::string>& files,
                           NamedPlugins named) {
  constexpr const char* kKey = "plugins";
  const Setting* const given = settings.find(kKey);
  const NamedCode code = named_code(settings);
  Setting all{kKey, {{}, true}, "--plugin"};
  const bool loads = named == NamedPlugins::loaded || code.plugins.empty();
  if (given != nullptr) {
    all = *given;
    try {
      for (const std::string& file : all.value.items) {
        if (loads) load(file);
      }
    } catch (const InputError& error) {
      refuse(*given, std::string("plugins: ") + error.what());
    }
  }
  for (const std::string& file : files) {
    load(file);
    const auto is_same = [&](const std::string& other) {
      return fs::weakly_canonical(file) == fs::weakly_canonical(other);
    };
    if (std::ranges::none_of(all.value.items, is_same)) all.value.items.push_back(file);
  }
  if (!all.value.items.empty()) settings.put(all);
  if (!loads) add_unloaded(settings, code.plugins, registry_);
}

}  // namespace fathom::workflow
