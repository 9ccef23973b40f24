#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom::workflow {

/// The keys of a g2o data set but its path, `dataset.` before each.
std::vector<std::string> graph_keys();
bool is_graph_key(const std::string& key);

/// The options that settings give, other keys aside; `component` is --component, `drop_self_edges`
/// the flag of this name.
GraphOptions graph_options(const Settings& settings, std::optional<int> component,
                           bool drop_self_edges);

/// For run.json: the keys that have an effect on this log, with their values.
std::vector<std::pair<std::string, std::string>> in_force(GraphOptions options,
                                                          const MeasurementLog& log);

}  // namespace fathom::workflow
