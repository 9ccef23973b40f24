#include "fathom/estimation/registry.hpp"

#include <algorithm>

#include "fathom/core/input_error.hpp"

namespace fathom {

void EstimatorRegistry::add(EstimatorEntry entry) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789_";
  if (entry.name.empty() || entry.name.find_first_not_of(kAllowed) != std::string::npos) {
    throw InputError("estimator '" + entry.name + "': expected a name of a-z, 0-9 and _");
  }
  for (const char* const word : {"dead_reckoning", "ground_truth", "automatic"}) {
    if (entry.name == word) throw InputError("estimator '" + entry.name + "': a word of studies");
  }
  if (!entry.create) throw InputError("estimator '" + entry.name + "': it cannot be made");
  const auto taken = std::ranges::find(entries_, entry.name, &EstimatorEntry::name);
  if (taken != entries_.end()) {
    const std::string by =
        taken->is_built_in() ? "is there already" : "comes from " + taken->plugin.string();
    throw InputError("estimator '" + entry.name + "': the name is taken, another one " + by);
  }
  entries_.push_back(std::move(entry));
}

const EstimatorEntry& EstimatorRegistry::find(const std::string& name) const {
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : entries_) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  const std::string hint = suggestion(name, names);
  throw InputError("unknown estimator '" + name + "'" +
                   (hint.empty() ? "; there are " + known + ", and those of --plugin FILE" : hint));
}

}  // namespace fathom
