#pragma once

#include <string>

#include "fathom/core/options.hpp"

namespace fathom {

/// Options that code filled in keep the same bounds as those of a config: each is set to itself.
/// Lists have no bounds of their own; those who use them check them.
template <class Options>
Options checked(Options options, const std::string& group) {
  OptionTable table;
  table.group(group, options);
  for (const OptionDescription& option : table.descriptions()) {
    if (option.type == "list of real") continue;
    table.set(option.key, OptionValue::scalar(table.value(option.key)));
  }
  return options;
}

}  // namespace fathom
