#include "fathom/study/configuration.hpp"

#include <algorithm>
#include <set>

namespace fathom {
namespace {

struct FileDatasetOptions {
  std::string path;

  void describe(OptionTable& table, const std::string& what) {
    table.text("path", path, what + "; relative to the working folder");
  }
};

template <class Describe>
std::vector<OptionDescription> described(Describe describe) {
  OptionTable table;
  describe(table);
  return table.descriptions();
}

std::vector<DatasetEntry> make_datasets() {
  SimulatedSurveyOptions simulation;
  FileDatasetOptions file;
  return {
      {"simulated", DatasetType::simulated, "a survey flown over a picture or a procedural floor",
       described([&](OptionTable& table) { simulation.describe(table); })},
      {"image_folder", DatasetType::image_folder,
       "pictures, altitude and odometry in the EuRoC/ASL layout",
       described([&](OptionTable& table) { file.describe(table, "the folder that holds mav0"); })},
      {"g2o", DatasetType::g2o, "a pose graph, straight to the estimators",
       described([&](OptionTable& table) { file.describe(table, "the g2o file"); })}};
}

// Everything of a configuration but its estimators, bound to the keys of one kind of data set.
void bind(Configuration& configuration, OptionTable& table) {
  table.integer("seed", configuration.seed, Range::between(0, 2147483647.0), "",
                "base seed of every noise stream and of RANSAC");
  table.enumeration<Alignment>("evaluation.alignment", configuration.alignment, alignment_names(),
                               "how an estimate is laid on the ground truth; never its scale");
  std::vector<std::pair<std::string, DatasetType>> types;
  for (const DatasetEntry& entry : datasets()) types.emplace_back(entry.name, entry.type);
  table.enumeration<DatasetType>("dataset.type", configuration.dataset, types, "kind of data set");
  table.group("front_end", configuration.front_end);
}

void bind_dataset(Configuration& configuration, OptionTable& table) {
  if (configuration.dataset == DatasetType::simulated) {
    table.group("dataset", configuration.simulation);
  } else {
    table.text("dataset.path", configuration.dataset_path, "where the data set is");
  }
}

bool is_estimator_key(const std::string& key) {
  return key.starts_with("estimator.") || key.starts_with("estimators.") ||
         key.starts_with("association.") || key == "estimator" || key == "estimators";
}

void set(OptionTable& table, const Setting& setting, const std::vector<std::string>& known) {
  if (!table.has(setting.key)) {
    refuse(setting, "unknown key '" + setting.key + "'" + suggestion(setting.key, known));
  }
  try {
    table.set(setting.key, setting.value);
  } catch (const InputError& error) {
    refuse(setting, error.what());
  }
}

std::string text_of(const Setting& setting) {
  if (setting.value.is_list || setting.value.items.size() != 1) {
    refuse(setting, setting.key + ": expected a single word");
  }
  return setting.value.items.front();
}

const EstimatorEntry& find_entry(const EstimatorRegistry& registry, const Settings& settings,
                                 const std::string& prefix) {
  const Setting* type = settings.find("type");
  if (type == nullptr) return registry.entries().front();
  try {
    return registry.find(text_of(*type));
  } catch (const InputError& error) {
    refuse(*type, prefix + "type: " + error.what());
  }
}

EstimatorConfiguration configure_estimator(const Settings& settings,
                                           const EstimatorRegistry& registry,
                                           const std::string& prefix) {
  const EstimatorEntry& entry = find_entry(registry, settings, prefix);
  EstimatorConfiguration estimator{entry.name, entry.name, {}};
  Settings own;
  for (const Setting& setting : settings.all()) {
    if (setting.key == "name") estimator.name = text_of(setting);
    if (setting.key != "name" && setting.key != "type") own.put(setting);
  }
  const bool is_file_name =
      estimator.name.find_first_of("/\\") == std::string::npos && !estimator.name.starts_with(".");
  if (estimator.name.empty() || !is_file_name) {
    refuse(*settings.find("name"),
           prefix + "name: it names a folder too: letters, digits, - and _");
  }
  estimator.values = estimator_values(own, entry, {}, prefix);
  return estimator;
}

std::vector<EstimatorConfiguration> configure_list(const Settings& settings,
                                                   const EstimatorRegistry& registry) {
  std::vector<EstimatorConfiguration> list;
  std::set<std::string> names;
  if (const Setting* scalar = settings.find("estimators")) {
    refuse(*scalar, "estimators: expected a list of maps, such as '- {type: ekf}'");
  }
  for (std::size_t i = 0; true; ++i) {
    const std::string prefix = "estimators." + std::to_string(i) + ".";
    const Settings own = settings.below(prefix);
    if (own.all().empty()) break;
    list.push_back(configure_estimator(own, registry, prefix));
    if (!names.insert(list.back().name).second) {
      refuse(own.all().front(),
             "two estimators are called '" + list.back().name + "'; give one of them another name");
    }
  }
  if (!list.empty()) return list;
  for (const EstimatorEntry& entry : registry.entries())
    list.push_back({entry.name, entry.name, {}});
  return list;
}

std::size_t find_reference(const Settings& settings, const Configuration& configuration) {
  const Setting* setting = settings.find("association.reference");
  if (setting == nullptr) return 0;
  std::vector<std::string> names;
  for (const EstimatorConfiguration& estimator : configuration.estimators) {
    names.push_back(estimator.name);
  }
  const auto found = std::find(names.begin(), names.end(), text_of(*setting));
  if (found == names.end()) {
    refuse(*setting, "association.reference: no estimator is called '" + text_of(*setting) + "'" +
                         suggestion(text_of(*setting), names));
  }
  return static_cast<std::size_t>(found - names.begin());
}

void refuse_keys_of_other_kind(const Settings& settings, ConfigurationKind kind) {
  for (const Setting& setting : settings.all()) {
    if (!is_estimator_key(setting.key)) continue;
    const bool of_list =
        setting.key.starts_with("estimators") || setting.key.starts_with("association.");
    if (kind == ConfigurationKind::single && of_list) {
      refuse(setting, "unknown key '" + setting.key +
                          "': a list of estimators is for 'compare'; one takes 'estimator.type'");
    }
    if (kind == ConfigurationKind::comparison && !of_list) {
      refuse(setting, "unknown key '" + setting.key +
                          "': 'compare' takes a list, 'estimators: [{type: ekf}, …]'");
    }
    if (setting.key.starts_with("association.") && setting.key != "association.reference") {
      refuse(setting, "unknown key '" + setting.key + "'; did you mean 'association.reference'?");
    }
  }
}

}  // namespace

const std::vector<DatasetEntry>& datasets() {
  static const std::vector<DatasetEntry> entries = make_datasets();
  return entries;
}

EstimatorValues estimator_values(const Settings& settings, const EstimatorEntry& entry,
                                 const EstimatorSetup& setup, const std::string& prefix) {
  std::vector<std::string> known{prefix + "type"};
  for (const OptionDescription& option : entry.options) known.push_back(prefix + option.key);
  EstimatorValues values;
  for (const Setting& setting : settings.all()) {
    const std::string full = prefix + setting.key;
    if (std::find(known.begin(), known.end(), full) == known.end()) {
      refuse(setting, "unknown key '" + full + "' of " + entry.name + suggestion(full, known));
    }
    values[setting.key] = setting.value;
    try {
      entry.create(setup, values);
    } catch (const InputError& error) {
      refuse(setting, prefix + error.what());
    }
  }
  return values;
}

Configuration configure(const Settings& settings, ConfigurationKind kind,
                        const EstimatorRegistry& registry) {
  Configuration configuration;
  OptionTable table;
  bind(configuration, table);
  // The type of the data set says which other keys there are, so it comes first.
  const std::vector<std::string> common = table.keys();
  if (const Setting* type = settings.find("dataset.type")) set(table, *type, common);
  bind_dataset(configuration, table);
  refuse_keys_of_other_kind(settings, kind);
  std::vector<std::string> known = table.keys();
  known.insert(known.end(), {"estimator.type", "estimators", "association.reference"});
  for (const Setting& setting : settings.all()) {
    if (!is_estimator_key(setting.key)) set(table, setting, known);
  }
  if (kind == ConfigurationKind::single) {
    if (const Setting* scalar = settings.find("estimator")) {
      refuse(*scalar, "estimator: expected a map, such as 'estimator: {type: ekf}'");
    }
    configuration.estimators = {
        configure_estimator(settings.below("estimator."), registry, "estimator.")};
  } else {
    configuration.estimators = configure_list(settings, registry);
    configuration.reference = find_reference(settings, configuration);
  }
  for (const std::string& key : table.keys()) {
    configuration.in_force.emplace_back(key, table.value(key));
  }
  return configuration;
}

}  // namespace fathom
