#include "fathom/estimation/registry.hpp"

#include "fathom/core/input_error.hpp"

namespace fathom {

void EstimatorRegistry::add(EstimatorEntry entry) {
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
                   (hint.empty() ? "; there are " + known : hint));
}

}  // namespace fathom
