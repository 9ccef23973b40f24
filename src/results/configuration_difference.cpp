#include <algorithm>
#include <map>

#include "fathom/core/input_error.hpp"
#include "result_schema.hpp"

namespace fathom {

std::string data_difference(const StudyDescription& there, const StudyDescription& here) {
  const std::map<std::string, std::string> old(there.data.begin(), there.data.end());
  const std::map<std::string, std::string> now(here.data.begin(), here.data.end());
  std::vector<std::string> changes;
  for (const auto& [file, hash] : now) {
    const auto found = old.find(file);
    if (found == old.end()) changes.push_back(file + " is new");
    if (found != old.end() && found->second != hash) changes.push_back(file + " has changed");
  }
  for (const auto& [file, hash] : old) {
    if (!now.contains(file)) changes.push_back(file + " is gone");
  }
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(changes.size(), kShown); ++i) {
    text += (i > 0 ? "; " : "") + changes[i];
  }
  if (changes.size() > kShown) text += "; and " + std::to_string(changes.size() - kShown) + " more";
  return text;
}

std::string difference(const StudyDescription& there, const StudyDescription& here) {
  const std::map<std::string, std::string> old(there.configuration.begin(),
                                               there.configuration.end());
  const std::map<std::string, std::string> now(here.configuration.begin(),
                                               here.configuration.end());
  std::string text;
  const auto say = [&text](const std::string& key, const std::string& was, const std::string& is) {
    if (!text.empty()) text += "; ";
    text.append(key).append(": ").append(was).append(" there, ").append(is).append(" here");
  };
  for (const auto& [key, value] : now) {
    const auto found = old.find(key);
    if (found == old.end()) {
      say(key, "absent", value);
    } else if (found->second != value) {
      say(key, found->second, value);
    }
  }
  for (const auto& [key, value] : old) {
    if (!now.contains(key)) say(key, value, "absent");
  }
  return text;
}

void require_same(const StudyDescription& there, const StudyDescription& here,
                  const std::filesystem::path& file) {
  constexpr const char* kOtherOut = "); use another --out, or remove the folder";
  const std::string differs = difference(there, here);
  if (!differs.empty()) {
    throw InputError(file.string(),
                     "holds results of another configuration (" + differs + kOtherOut);
  }
  const std::string changes = data_difference(there, here);
  if (!changes.empty()) {
    throw InputError(file.string(), "holds results of other data (" + changes + kOtherOut);
  }
}

}  // namespace fathom
