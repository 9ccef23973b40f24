#include "fathom/configuration/isolation.hpp"

#include <algorithm>

namespace fathom {

void IsolationOptions::describe(OptionTable& table) {
  table.enumeration<Isolation>("isolation", isolation,
                               {{"automatic", Isolation::automatic},
                                {"process", Isolation::process},
                                {"none", Isolation::none}},
                               "a process of its own for each run; automatic: where the estimator "
                               "is not built in");
  table.real("time_limit_s", time_limit_s, Range::between(1e-3, 1e7), "s",
             "of a run in a process of its own: wall time");
  table.integer("memory_limit_mib", memory_limit_mib, Range::between(1, 1e9), "MiB",
                "likewise: what it may allocate");
}

bool IsolationOptions::is_isolated(const EstimatorEntry& entry) const {
  return isolation == Isolation::process ||
         (isolation == Isolation::automatic && (!entry.is_built_in() || entry.runs_program));
}

bool is_isolation_key(const std::string& key) {
  static const std::vector<std::string> keys = [] {
    IsolationOptions options;
    OptionTable table;
    options.describe(table);
    return table.keys();
  }();
  return std::ranges::find(keys, key) != keys.end();
}

}  // namespace fathom
