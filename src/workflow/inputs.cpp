#include "fathom/workflow/inputs.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "fathom/configuration/config_file.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/program.hpp"
#include "fathom/datasets/picture_folder.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

Settings settings_of(const fs::path& path) {
  if (path.empty()) return {};
  const bool is_graph = path.extension() == ".g2o" || path.extension() == ".graph";
  if (!is_graph && !fs::is_directory(path)) {
    return read_settings(path);
  }
  std::error_code error;
  if (fs::exists(path / "metrics.json", error) && fs::exists(path / "measurements.g2o", error)) {
    throw InputError(path.string(), "is the folder of a run or a study, no survey");
  }
  const std::string type = is_graph                        ? "g2o"
                           : is_plain_picture_folder(path) ? "pictures"
                                                           : "image_folder";
  Settings settings;
  settings.put({"dataset.type", OptionValue::scalar(type), path.string()});
  settings.put({"dataset.path", OptionValue::scalar(path.string()), path.string()});
  return settings;
}

void require_keys(const Settings& settings, const std::string& source) {
  if (settings.all().empty()) throw InputError(source, "is empty; expected keys");
}

std::vector<fs::path> inputs_of(const fs::path& path, const Settings& settings) {
  std::vector<fs::path> inputs{path};
  for (const char* key : {"dataset.path", "dataset.world.picture", "dataset.mask"}) {
    const Setting* setting = settings.find(key);
    if (setting != nullptr) inputs.emplace_back(word_of(*setting, key));
  }
  return inputs;
}

std::string stem_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) return path.stem().empty() ? "run" : path.stem().string();
  fs::path folder = fs::absolute(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  // All recordings in the EuRoC/ASL layout have a folder of that name.
  if (folder.filename() == "mav0") folder = folder.parent_path();
  return folder.filename().empty() ? "run" : folder.filename().string();
}

// Of one name and several contents, as of two builds of a program, by order of content: each has a
// name of its own, wherever they lie.
Fingerprint with_numbers(Fingerprint sorted) {
  std::string before;
  int number = 1;
  for (auto& [name, hash] : sorted) {
    number = name == before ? number + 1 : 1;
    before = name;
    if (number > 1) name += " (" + std::to_string(number) + ")";
  }
  return sorted;
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
  data.erase(std::unique(data.begin(), data.end()), data.end());
  return with_numbers(std::move(data));
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

}  // namespace fathom::workflow
