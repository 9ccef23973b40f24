#include "near_folders.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <system_error>

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

// The words of sensors' names, those that others use for them too, each with the folder read.
const std::map<std::string, std::string>& folders_by_word() {
  static const std::map<std::string, std::string> folders{
      {"altimeter", "altimeter0"},
      {"altitude", "altimeter0"},
      {"attitude", "attitude0"},
      {"cam", "cam0"},
      {"camera", "cam0"},
      {"compass", "compass0"},
      {"groundtruth", "state_groundtruth_estimate0"},
      {"odom", "odometry0"},
      {"odometry", "odometry0"},
      {"position", "position0"},
      {"stategroundtruthestimate", "state_groundtruth_estimate0"}};
  return folders;
}

// Its letters alone, small: numbers, capitals and what stands between words are what differs most.
std::string word_of_folder(const std::string& name) {
  std::string word;
  for (const char c : name) {
    if (c >= 'a' && c <= 'z') word += c;
    if (c >= 'A' && c <= 'Z') word += static_cast<char>(c - 'A' + 'a');
  }
  return word;
}

// The folders that may be meant; none of a name that is read.
std::vector<std::string> meant_by(const std::string& name) {
  std::vector<std::string> words;
  for (const auto& [word, folder] : folders_by_word()) {
    if (folder == name) return {};
    words.push_back(word);
  }
  std::vector<std::string> folders;
  for (const std::string& word : nearest(word_of_folder(name), words)) {
    const std::string& folder = folders_by_word().at(word);
    if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(folder);
  }
  return folders;
}

std::vector<std::string> folder_names(const fs::path& mav0) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(mav0, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code unknown;
    const std::string name = entry->path().filename().string();
    if (!name.starts_with('.') && entry->is_directory(unknown)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace

std::vector<std::string> unread_folders(const fs::path& mav0) {
  const std::vector<std::string> names = folder_names(mav0);
  const auto is_there = [&names](const std::string& name) {
    return std::ranges::binary_search(names, name);
  };
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    std::vector<std::string> meant = meant_by(name);
    if (meant == std::vector<std::string>{"cam0"}) continue;  // another camera
    const auto found = folders_by_word().find(word_of_folder(name));
    if (found != folders_by_word().end() && is_there(found->second) && !meant.empty()) {
      lines.push_back(
          fmt::format("{} is not read, as {} is there", (mav0 / name).string(), found->second));
      continue;
    }
    // What is read was found: this may be a copy of it.
    std::erase_if(meant, is_there);
    if (meant.empty()) continue;
    lines.push_back(fmt::format("{} is not read; did you mean '{}'?", (mav0 / name).string(),
                                joined(meant, "' or '")));
  }
  return lines;
}

std::string near_folder_hint(const fs::path& mav0, const std::string& sensor) {
  for (const std::string& name : folder_names(mav0)) {
    const std::vector<std::string> meant = meant_by(name);
    if (std::ranges::find(meant, sensor) == meant.end()) continue;
    return fmt::format("; rename {} to {} if that is what it holds", name, sensor);
  }
  return "";
}

}  // namespace fathom
