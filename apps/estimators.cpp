#include "apps/estimators.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <sstream>

#include "apps/flags.hpp"
#include "fathom/configuration/config_file.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/program.hpp"
#include "fathom/estimation/plugin.hpp"
#include "fathom/estimators/builtin.hpp"

namespace fathom {
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

class KnownEstimators {
 public:
  KnownEstimators() {
    registry_.add(command_entry());
    const char* const places = std::getenv(kSearchPath);
    if (places == nullptr) return;
    std::istringstream words(places);
    for (std::string place; std::getline(words, place, ':');) {
      if (place.empty()) continue;
      try {
        for (const fs::path& file : shared_objects_of(place)) load(file);
      } catch (const InputError& error) {
        throw InputError(std::string(kSearchPath) + ": " + error.what());
      }
    }
  }

  void load(const fs::path& file) {
    const std::lock_guard lock(changing_);
    const fs::path known_as = fs::weakly_canonical(file);
    const auto loaded = loaded_.find(known_as);
    if (loaded == loaded_.end()) {
      load_plugin(file, registry_);
      loaded_[known_as] = fingerprint({known_as});
    } else if (loaded->second != fingerprint({known_as})) {
      throw InputError(file.string(), "has changed since it was loaded; start the program again");
    }
  }

  const EstimatorRegistry& registry() const { return registry_; }
  EstimatorRegistry copy() {
    const std::lock_guard lock(changing_);
    return registry_;
  }

 private:
  std::recursive_mutex changing_;  ///< a plug-in in Python may ask for the others as it is read
  EstimatorRegistry registry_ = builtin_estimators();
  std::map<fs::path, Fingerprint> loaded_;  ///< with the content at that time
};

// The program, and what it is given as an argument and is a file: a script, or its settings.
std::set<fs::path> files_of_command(const EstimatorConfiguration& estimator) {
  std::set<fs::path> files;
  const auto command = estimator.values.find("command");
  if (command == estimator.values.end()) return files;
  const std::vector<std::string> words = words_of_command(command->second.text());
  if (words.empty()) return files;
  files.insert(find_program(words.front()));
  for (const std::string& word : words) {
    if (fs::is_regular_file(word)) files.insert(word);
  }
  return files;
}

KnownEstimators& known_estimators() {
  static KnownEstimators known;
  return known;
}

}  // namespace

const EstimatorRegistry& estimators() {
  return known_estimators().registry();
}

EstimatorRegistry known_estimators_now() {
  return known_estimators().copy();
}

void load_plugins(const std::vector<std::string>& files) {
  for (const std::string& file : files) known_estimators().load(file);
}

void add_plugins_to(Command& command, std::vector<std::string>& files) {
  command.texts("--plugin", files, "FILE", "Further estimators: a shared object, or a .py file");
}

void load_plugins(Settings& settings, const std::vector<std::string>& files) {
  constexpr const char* kKey = "plugins";
  estimators();  // a fault of the path is not one of a setting
  const Setting* const given = settings.find(kKey);
  Setting all{kKey, {{}, true}, "--plugin"};
  if (given != nullptr) {
    all = *given;
    if (!all.value.is_list) refuse(*given, "plugins: expected a list of files, [FILE]");
    try {
      load_plugins(all.value.items);
    } catch (const InputError& error) {
      refuse(*given, std::string("plugins: ") + error.what());
    }
  }
  load_plugins(files);
  for (const std::string& file : files) {
    const auto is_same = [&](const std::string& other) {
      return fs::weakly_canonical(file) == fs::weakly_canonical(other);
    };
    if (std::ranges::none_of(all.value.items, is_same)) all.value.items.push_back(file);
  }
  if (!all.value.items.empty()) settings.put(all);
}

Fingerprint with_code(Fingerprint data, const std::vector<EstimatorConfiguration>& all,
                      const EstimatorRegistry& registry) {
  std::set<fs::path> plugins;
  std::set<fs::path> programs;
  std::set<std::pair<std::string, std::string>> code;
  for (const EstimatorConfiguration& one : all) {
    const EstimatorEntry& entry = registry.find(one.type);
    if (!entry.is_built_in() && entry.code.empty()) plugins.insert(entry.plugin);
    code.insert(entry.code.begin(), entry.code.end());
    if (entry.runs_program) programs.merge(files_of_command(one));
  }
  // Wherever it lies: the same content is the same code.
  const auto add = [&](const char* what, const std::set<fs::path>& files) {
    for (const auto& [file, hash] : fingerprint({files.begin(), files.end()})) {
      data.emplace_back(what + fs::path(file).filename().string(), hash);
    }
  };
  add("plug-in ", plugins);
  add("program ", programs);
  for (const auto& [name, hash] : code) data.emplace_back("plug-in " + name, hash);
  std::sort(data.begin(), data.end());
  return data;
}

std::vector<EstimatorConfiguration> estimators_in(const std::vector<Configuration>& cells) {
  std::vector<EstimatorConfiguration> all;
  for (const Configuration& cell : cells) {
    all.insert(all.end(), cell.estimators.begin(), cell.estimators.end());
    if (cell.reference.kind != CandidateReference::Kind::ground_truth) {
      all.push_back(cell.reference.estimator);
    }
  }
  return all;
}

}  // namespace fathom
