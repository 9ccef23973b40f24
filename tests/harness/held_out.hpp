#pragma once

#include <map>
#include <string>

#include "fathom/evaluation/metrics.hpp"

namespace fathom::test {

using Metrics = std::map<std::string, double>;

/// Of a run's metrics, those that no clock says: of held-out loops, or all others.
inline Metrics metrics_of(const Metrics& all, bool of_held_out) {
  Metrics some;
  for (const auto& [name, value] : all) {
    if (!is_cost_metric(name) && name.starts_with("held_out_") == of_held_out) some[name] = value;
  }
  return some;
}

}  // namespace fathom::test
