#include "graph_keys.hpp"

#include <algorithm>

namespace fathom::workflow {
namespace {

const std::string kPrefix = "dataset.";

}  // namespace

std::vector<std::string> graph_keys() {
  GraphOptions options;
  OptionTable table;
  options.describe(table);
  std::vector<std::string> keys = table.keys();
  for (std::string& key : keys) key = kPrefix + key;
  return keys;
}

bool is_graph_key(const std::string& key) {
  const std::vector<std::string> keys = graph_keys();
  return std::ranges::find(keys, key) != keys.end();
}

GraphOptions graph_options(const Settings& settings, std::optional<int> component,
                           bool drop_self_edges) {
  GraphOptions options;
  OptionTable table;
  options.describe(table);
  for (const Setting& setting : settings.all()) {
    if (!is_graph_key(setting.key)) continue;
    const std::string key = setting.key.substr(kPrefix.size());
    if (key == "component" && component) refuse(setting, "--component says it already");
    try {
      table.set(key, setting.value);
    } catch (const InputError& error) {
      refuse(setting, kPrefix + error.what());
    }
  }
  if (component) options.component = component;
  if (drop_self_edges) options.drop_self_edges = true;
  return options;
}

std::vector<std::pair<std::string, std::string>> in_force(GraphOptions options,
                                                          const MeasurementLog& log) {
  OptionTable table;
  options.describe(table);
  std::vector<std::pair<std::string, std::string>> values;
  for (const std::string& key : table.keys()) {
    const bool counts = key == "component"         ? options.component.has_value()
                        : key == "drop_self_edges" ? log.self_edges > 0
                                                   : log.hole_count() > 0;
    if (counts) values.emplace_back(kPrefix + key, table.value(key));
  }
  return values;
}

}  // namespace fathom::workflow
