#include "fathom/datasets/data_set.hpp"

namespace fathom {

Trial DataSet::trial(const DataSetValues& /*values*/, const TrialNoise& /*noise*/) const {
  return {};
}

const DataSetEntry& find_data_set(const std::string& name) {
  std::vector<std::string> names;
  for (const DataSetEntry& entry : data_sets()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError("unknown data set '" + name + "'" + suggestion(name, names));
}

}  // namespace fathom
