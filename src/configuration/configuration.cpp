#include "fathom/configuration/configuration.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <string>

#include "estimator_list.hpp"
#include "fathom/configuration/study.hpp"
#include "origin_keys.hpp"
#include "run_keys.hpp"
#include "study_options.hpp"

namespace fathom {
namespace {

constexpr const char* kDataSet = "dataset";
constexpr const char* kFrontEnd = "front_end";

std::vector<std::string> data_set_names() {
  std::vector<std::string> names;
  for (const DataSetEntry& entry : data_sets()) names.push_back(entry.name);
  return names;
}

// Everything of a configuration but its data set, its study and its estimators.
void bind(Configuration& configuration, OptionTable& table) {
  table.integer("seed", configuration.seed, Range::between(0, 2147483647.0), "",
                "base seed of every noise stream and of RANSAC");
  table.enumeration<Alignment>("evaluation.alignment", configuration.study.evaluation.alignment,
                               alignment_names(),
                               "how an estimate is laid on the ground truth; never its scale");
  table.choice("dataset.type", configuration.dataset.type, data_set_names(), "kind of data set");
  table.group(kFrontEnd, configuration.front_end);
  bind_runs(configuration, table);
}

// The keys that a comparison alone has.
bool is_list_key(const std::string& key) {
  return key == "estimators" || key.starts_with("estimators.");
}

// Keys that no table describes.
bool is_estimator_key(const std::string& key) {
  return key == "estimator" || key.starts_with("estimator.") || is_list_key(key) ||
         is_reference_key(key);
}

[[noreturn]] void refuse_unknown(const OptionTable& table, const Setting& setting) {
  std::vector<std::string> known = table.keys();
  known.insert(known.end(), {"estimator.type", "estimators", "association.reference"});
  for (const std::string& key : known) {
    if (!key.starts_with(setting.key + ".")) continue;
    refuse(setting, fmt::format("{}: expected a map of keys, such as '{}'", setting.key, key));
  }
  refuse(setting, fmt::format("unknown key '{}'{}", setting.key, suggestion(setting.key, known)));
}

void set(OptionTable& table, const Setting& setting) {
  if (!table.has(setting.key)) refuse_unknown(table, setting);
  try {
    table.set(setting.key, setting.value);
  } catch (const InputError& error) {
    refuse(setting, error.what());
  }
}

void refuse_keys_of_other_kind(const Settings& settings, ConfigurationKind kind) {
  for (const Setting& setting : settings.all()) {
    if (kind == ConfigurationKind::single && is_study_key(setting.key)) {
      refuse(setting, "unknown key '" + setting.key + "': it is for 'compare'");
    }
    if (!is_estimator_key(setting.key) || is_study_key(setting.key)) continue;
    const bool of_list = is_list_key(setting.key);
    if (kind == ConfigurationKind::single && of_list) {
      refuse(setting, "unknown key '" + setting.key +
                          "': a list of estimators is for 'compare'; one takes 'estimator.type'");
    }
    if (kind == ConfigurationKind::comparison && !of_list) {
      refuse(setting, "unknown key '" + setting.key +
                          "': 'compare' takes a list, 'estimators: [{type: ekf}, …]'");
    }
  }
}

std::vector<IgnoredKey> ignored_keys(const Configuration& configuration,
                                     const DataSetOptions& data_set) {
  std::vector<IgnoredKey> ignored = below(kFrontEnd, configuration.front_end.ignored_keys());
  std::ranges::copy(below(kDataSet, data_set.ignored_keys()), std::back_inserter(ignored));
  return ignored;
}

bool is_among(const std::vector<IgnoredKey>& ignored, const std::string& key) {
  return std::ranges::find(ignored, key, &IgnoredKey::key) != ignored.end();
}

std::string unused_text(const Setting& setting, const std::string& chooser,
                        const std::string& choice) {
  return fmt::format("{}: {}: {} {} has no use for it and would ignore it", setting.origin,
                     setting.key, chooser, choice);
}

std::vector<UnusedSetting> unused_settings(const Settings& settings,
                                           const std::vector<IgnoredKey>& ignored,
                                           const OptionTable& table) {
  std::vector<UnusedSetting> unused;
  for (const auto& [key, chooser] : ignored) {
    const Setting* setting = settings.find(key);
    if (setting == nullptr) continue;
    unused.push_back({key, unused_text(*setting, chooser, table.value(chooser))});
  }
  return unused;
}

void check_front_end(const Settings& settings, const FrontEndOptions& options) {
  try {
    options.check();
  } catch (const InputError& error) {
    const std::string what = std::string(kFrontEnd) + "." + error.what();
    const Setting* about = settings.find(what.substr(0, what.find(':')));
    if (about == nullptr) throw InputError(what);
    refuse(*about, what);
  }
}

DataSetValues given_values(const Settings& settings, const DataSetEntry& entry) {
  DataSetValues values;
  const std::string prefix = std::string(kDataSet) + ".";
  for (const Setting& setting : settings.all()) {
    const bool is_general =
        setting.key == "dataset.type" || (is_origin_key(setting.key) && !entry.takes_origin);
    if (is_general || !setting.key.starts_with(prefix)) continue;
    values[setting.key.substr(prefix.size())] = setting.value;
  }
  return values;
}

void configure_estimators(Configuration& configuration, const Settings& settings,
                          ConfigurationKind kind, const EstimatorRegistry& registry) {
  if (kind == ConfigurationKind::comparison) {
    configuration.estimators = configure_list(settings, registry);
    configuration.reference = configure_reference(settings, configuration.estimators, registry);
    check_selection_isolated(settings, configuration, registry);
    return;
  }
  if (const Setting* scalar = settings.find("estimator")) {
    refuse(*scalar, "estimator: expected a map, such as 'estimator: {type: ekf}'");
  }
  configuration.estimators = {
      configure_estimator(settings.below("estimator."), registry, "estimator.")};
  configuration.reference = by_contender(configuration.estimators.front());
}

}  // namespace

bool selects_by_reference(const Configuration& cell) {
  return cell.study.association == Association::shared &&
         !find_data_set(cell.dataset.type).is_graph;
}

ConfigurationKind kind_of(const Settings& settings) {
  const std::vector<Setting>& all = settings.all();
  return std::any_of(all.begin(), all.end(),
                     [](const Setting& setting) {
                       return is_list_key(setting.key) || is_study_key(setting.key);
                     })
             ? ConfigurationKind::comparison
             : ConfigurationKind::single;
}

Configuration configure(const Settings& settings, ConfigurationKind kind,
                        const EstimatorRegistry& registry) {
  std::vector<UnusedSetting> unused;
  Configuration configuration = configure(settings, kind, registry, unused);
  if (!unused.empty()) throw InputError(unused.front().message);
  return configuration;
}

Configuration configure(const Settings& settings, ConfigurationKind kind,
                        const EstimatorRegistry& registry, std::vector<UnusedSetting>& unused) {
  Configuration configuration;
  OptionTable table;
  bind(configuration, table);
  // The type of the data set says which other keys there are, so it comes first.
  if (const Setting* type = settings.find("dataset.type")) set(table, *type);
  const DataSetEntry& entry = find_data_set(configuration.dataset.type);
  const std::unique_ptr<DataSetOptions> data_set = entry.make_options();
  table.group(kDataSet, *data_set);
  bind_origin(configuration.dataset.type, configuration.origin, table);
  if (kind == ConfigurationKind::comparison) configuration.study.describe(table);
  refuse_keys_of_other_kind(settings, kind);
  for (const Setting& setting : settings.all()) {
    if (!is_estimator_key(setting.key)) set(table, setting);
    configuration.origins[setting.key] = setting.origin;
  }
  configuration.dataset.values = given_values(settings, entry);
  check_front_end(settings, configuration.front_end);
  check_origin(settings, configuration.origin);
  check_study(settings, configuration.study, entry, *data_set);
  std::vector<IgnoredKey> ignored = ignored_keys(configuration, *data_set);
  std::ranges::copy(ignored_study_keys(settings, configuration.study), std::back_inserter(ignored));
  unused = unused_settings(settings, ignored, table);
  add_unused_references(settings, configuration, unused);
  add_unused_trials(settings, configuration.study, entry, unused);
  configure_estimators(configuration, settings, kind, registry);
  add_unused_limits(settings, configuration, registry, unused);
  for (std::size_t place = 0; place < table.descriptions().size(); ++place) {
    const OptionDescription& option = table.descriptions()[place];
    configuration.types[option.key] = option.type;
    // A survey that is nowhere on Earth has no such keys.
    if (is_origin_key(option.key) && !configuration.origin.is_given()) continue;
    if (is_among(ignored, option.key)) continue;
    if (is_run_key_without_effect(option.key, configuration, registry)) continue;
    configuration.in_force.emplace_back(option.key, table.value_at(place));
  }
  return configuration;
}

std::vector<OptionDescription> keys_in_force(const std::map<std::string, std::string>& values) {
  Configuration configuration;
  OptionTable table;
  bind(configuration, table);
  const auto type = values.find("dataset.type");
  if (type != values.end()) configuration.dataset.type = type->second;
  const auto data_set = find_data_set(configuration.dataset.type).make_options();
  table.group(kDataSet, *data_set);
  bind_origin(configuration.dataset.type, configuration.origin, table);
  for (const OptionDescription& option : table.descriptions()) {
    const auto value = values.find(option.key);
    // A list decides over no other key.
    if (value == values.end() || option.type.starts_with("list")) continue;
    table.set(option.key, OptionValue::scalar(value->second));
  }
  const std::vector<IgnoredKey> ignored = ignored_keys(configuration, *data_set);
  std::vector<OptionDescription> in_force;
  std::ranges::copy_if(table.descriptions(), std::back_inserter(in_force),
                       [&](const auto& option) { return !is_among(ignored, option.key); });
  return in_force;
}

}  // namespace fathom
