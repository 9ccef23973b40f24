#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "result_schema.hpp"

namespace fathom {
namespace {

std::string first_of(std::vector<std::string> all, std::size_t most) {
  if (all.size() > most) {
    const std::size_t more = all.size() - most;
    all.resize(most);
    all.push_back("and " + std::to_string(more) + " more");
  }
  return joined(all, "; ");
}

}  // namespace

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
  return first_of(std::move(changes), 3);
}

std::string difference(const StudyDescription& there, const StudyDescription& here) {
  const std::map<std::string, std::string> old(there.configuration.begin(),
                                               there.configuration.end());
  const std::map<std::string, std::string> now(here.configuration.begin(),
                                               here.configuration.end());
  // What both have tells most; another data set brings dozens of other keys.
  std::vector<std::string> changed;
  std::vector<std::string> others;
  const auto said = [](const std::string& key, const std::string& was, const std::string& is) {
    return key + ": " + was + " there, " + is + " here";
  };
  for (const auto& [key, value] : now) {
    const auto found = old.find(key);
    if (found == old.end()) {
      others.push_back(said(key, "absent", value));
    } else if (found->second != value) {
      changed.push_back(said(key, found->second, value));
    }
  }
  for (const auto& [key, value] : old) {
    if (!now.contains(key)) others.push_back(said(key, value, "absent"));
  }
  changed.insert(changed.end(), others.begin(), others.end());
  return first_of(std::move(changed), 6);
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
