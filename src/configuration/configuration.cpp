#include "fathom/configuration/configuration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fathom/configuration/study_description.hpp"

namespace fathom {
namespace {

struct FileDatasetOptions {
  std::string path;

  void describe(OptionTable& table, const std::string& what) {
    table.text("path", path, what + "; relative to the working folder");
  }
};

void describe_odometry(OptionTable& table, const std::string& key, FolderOdometry& odometry) {
  table.enumeration<FolderOdometry>(
      key, odometry,
      {{"recorded", FolderOdometry::recorded},
       {"visual_odometry", FolderOdometry::visual_odometry}},
      "dead reckoning: odometry0, where there is one; or registered pictures in any case");
}

template <class Describe>
std::vector<OptionDescription> described(Describe describe) {
  OptionTable table;
  describe(table);
  return table.descriptions();
}

std::vector<DatasetEntry> make_datasets() {
  SimulatedSurveyOptions simulation;
  FileDatasetOptions file;
  FolderOdometry odometry = FolderOdometry::recorded;
  AddedNoiseOptions added_noise;
  return {
      {"simulated", DatasetType::simulated, "a survey flown over a picture or a procedural floor",
       described([&](OptionTable& table) { simulation.describe(table); })},
      {"image_folder", DatasetType::image_folder,
       "pictures, altitude and odometry in the EuRoC/ASL layout",
       described([&](OptionTable& table) {
         file.describe(table, "the folder that holds mav0");
         describe_odometry(table, "odometry.source", odometry);
         table.group("added_noise", added_noise);
       })},
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
    if (configuration.dataset == DatasetType::image_folder) {
      describe_odometry(table, "dataset.odometry.source", configuration.folder_odometry);
      table.group("dataset.added_noise", configuration.added_noise);
    }
  }
}

// The keys that a comparison alone has.
bool is_list_key(const std::string& key) {
  return key == "estimators" || key.starts_with("estimators.");
}

bool is_study_key(const std::string& key) {
  constexpr std::array kWords{"trials",
                              "jobs",
                              "sweep",
                              "evaluation.rpe_keyframes",
                              "evaluation.rpe_distances_m",
                              "evaluation.min_overlap"};
  return std::any_of(kWords.begin(), kWords.end(), [&](const char* word) { return key == word; }) ||
         key.starts_with("sweep.") || key.starts_with("report.") || key.starts_with("association.");
}

// Keys that no table describes.
bool is_estimator_key(const std::string& key) {
  return key == "estimator" || key.starts_with("estimator.") || is_list_key(key) ||
         key == "association.reference";
}

void set(OptionTable& table, const Setting& setting, const std::vector<std::string>& known) {
  if (!table.has(setting.key)) {
    for (const std::string& key : known) {
      if (!key.starts_with(setting.key + ".")) continue;
      refuse(setting, setting.key + ": expected a map of keys, such as '" + key + "'");
    }
    refuse(setting, "unknown key '" + setting.key + "'" + suggestion(setting.key, known));
  }
  try {
    table.set(setting.key, setting.value);
  } catch (const InputError& error) {
    refuse(setting, error.what());
  }
}

const EstimatorEntry& find_entry(const EstimatorRegistry& registry, const Settings& settings,
                                 const std::string& prefix) {
  const Setting* type = settings.find("type");
  if (type == nullptr) return registry.entries().front();
  const std::string& name = word_of(*type, prefix + "type");
  try {
    return registry.find(name);
  } catch (const InputError& error) {
    refuse(*type, prefix + "type: " + error.what());
  }
}

bool is_plain_word(const std::string& name) {
  constexpr const char* kAllowed =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
  return !name.empty() && name.find_first_not_of(kAllowed) == std::string::npos;
}

void refuse_unused(const Settings& own, const EstimatorEntry& entry, const std::string& prefix) {
  for (const std::string& key : entry.unused_options) {
    if (const Setting* setting = own.find(key)) {
      refuse(*setting, prefix + key + ": " + entry.name + " has no use for it and would ignore it");
    }
  }
}

EstimatorConfiguration configure_estimator(const Settings& settings,
                                           const EstimatorRegistry& registry,
                                           const std::string& prefix) {
  const EstimatorEntry& entry = find_entry(registry, settings, prefix);
  EstimatorConfiguration estimator{entry.name, entry.name, {}};
  Settings own;
  for (const Setting& setting : settings.all()) {
    if (setting.key == "name") estimator.name = word_of(setting, prefix + "name");
    if (setting.key != "name" && setting.key != "type") own.put(setting);
  }
  if (!is_plain_word(estimator.name)) {
    refuse(*settings.find("name"),
           prefix + "name: it names a folder too: letters, digits, - and _");
  }
  if (estimator.name == kDeadReckoning) {
    refuse(*settings.find("name"), prefix + "name: dead_reckoning is the baseline of every table");
  }
  if (prefix != "estimator.") refuse_unused(own, entry, prefix);
  estimator.values = estimator_values(own, entry, {}, prefix);
  return estimator;
}

// No setting of the list may go unread: not one of `estimators.7` where there are three of them.
void refuse_unused_items(const Settings& settings, std::size_t count) {
  std::vector<std::string> prefixes;
  for (std::size_t i = 0; i < count; ++i) {
    prefixes.push_back("estimators." + std::to_string(i) + ".");
  }
  for (const Setting& setting : settings.all()) {
    if (!setting.key.starts_with("estimators.")) continue;
    const auto is_of = [&](const std::string& prefix) { return setting.key.starts_with(prefix); };
    if (std::any_of(prefixes.begin(), prefixes.end(), is_of)) continue;
    refuse(setting, setting.key +
                        ": expected a list of maps, such as '- {type: ekf}', numbered from 0 "
                        "without a gap");
  }
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
  refuse_unused_items(settings, list.size());
  if (!list.empty()) return list;
  for (const EstimatorEntry& entry : registry.entries()) {
    list.push_back({entry.name, entry.name, {}});
  }
  return list;
}

std::size_t find_reference(const Settings& settings, const Configuration& configuration) {
  const Setting* setting = settings.find("association.reference");
  if (setting == nullptr) return 0;
  std::vector<std::string> names;
  for (const EstimatorConfiguration& estimator : configuration.estimators) {
    names.push_back(estimator.name);
  }
  const std::string& name = word_of(*setting, "association.reference");
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    refuse(*setting, "association.reference: no estimator is called '" + name + "'" +
                         suggestion(name, names));
  }
  return static_cast<std::size_t>(found - names.begin());
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

constexpr const char* kFrontEnd = "front_end.";

void refuse_ignored(const Settings& settings, const std::vector<IgnoredKey>& ignored,
                    const OptionTable& table) {
  for (const auto& [name, chooser] : ignored) {
    const std::string key = kFrontEnd + name;
    if (const Setting* setting = settings.find(key)) {
      refuse(*setting, key + ": " + chooser + " " + table.value(kFrontEnd + chooser) +
                           " has no use for it and would ignore it");
    }
  }
}

constexpr const char* kFalseLoops = "association.false_loops.";

// Options of false loops that say nothing beside the others. A share of 0 that is given may be one
// of several: a sweep begins without false loops and keeps the rest.
std::vector<std::string> ignored_of_false_loops(const Settings& settings,
                                                const SpoilOptions& options) {
  const std::string prefix = kFalseLoops;
  if (settings.find(prefix + "share") == nullptr) {
    return {prefix + "kind", prefix + "group_size", prefix + "reach"};
  }
  std::vector<std::string> ignored;
  if (options.kind != FalseLoopKind::grouped) ignored.push_back(prefix + "group_size");
  if (options.kind != FalseLoopKind::local) ignored.push_back(prefix + "reach");
  return ignored;
}

void refuse_ignored_of_false_loops(const Settings& settings, const SpoilOptions& options) {
  for (const std::string& key : ignored_of_false_loops(settings, options)) {
    const Setting* setting = settings.find(key);
    if (setting == nullptr) continue;
    const bool has_share = settings.find(std::string(kFalseLoops) + "share") != nullptr;
    refuse(*setting, key + ": " +
                         (has_share ? "kind " + name_of(options.kind) : "a study without share") +
                         " has no use for it and would ignore it");
  }
}

// What no single option's bounds can say.
void check(const Settings& settings, const Configuration& configuration) {
  const StudyOptions& study = configuration.study;
  const Setting* reference = settings.find("association.reference");
  if (reference != nullptr && study.association == Association::own) {
    refuse(*reference,
           "association.reference: nobody's estimate but each one's own picks the loop candidates; "
           "use association.mode: shared");
  }
  if (configuration.dataset == DatasetType::g2o) {
    if (study.trials > 1 && study.false_loops.share == 0.0) {
      refuse(*settings.find("trials"),
             "trials: a pose graph without false loops has nothing to draw; expected 1");
    }
    if (study.association == Association::own) {
      refuse(*settings.find("association.mode"),
             "association.mode: a pose graph has its loops; expected shared");
    }
  }
  for (const double keyframes : study.rpe_keyframes) {
    if (keyframes >= 1.0 && keyframes == std::floor(keyframes) && keyframes < 1e9) continue;
    refuse(*settings.find("evaluation.rpe_keyframes"),
           "evaluation.rpe_keyframes: expected whole numbers >= 1");
  }
  for (const double distance_m : study.rpe_distances_m) {
    if (distance_m > 0.0) continue;
    refuse(*settings.find("evaluation.rpe_distances_m"),
           "evaluation.rpe_distances_m: expected numbers in m > 0");
  }
}

}  // namespace

void StudyOptions::describe(OptionTable& table) {
  table.integer("trials", trials, Range::between(1, 1e6), "",
                "runs of every estimator in every cell, each with noise of its own");
  table.integer("jobs", jobs, Range::between(1, 1024), "",
                "trials at work at the same time; cost is comparable at 1 alone");
  table.enumeration<Association>(
      "association.mode", association, {{"shared", Association::shared}, {"own", Association::own}},
      "loop candidates by the reference's estimate, for all, or by each estimator's own");
  table.group("association.false_loops", false_loops);
  table.reals("evaluation.rpe_keyframes", rpe_keyframes, 1, "keyframes",
              "relative errors over so many keyframes");
  table.reals("evaluation.rpe_distances_m", rpe_distances_m, 1, "m",
              "relative errors over such distances along the true path");
  table.real("evaluation.min_overlap", min_overlap, Range::between(0.01, 1.0), "",
             "true overlap from which on a pair of keyframes should be found (loop_recall)");
  table.text("report.title", title, "title of the report");
  table.words("report.metrics", metrics, "metrics of the tables, in this order");
}

const std::vector<DatasetEntry>& datasets() {
  static const std::vector<DatasetEntry> entries = make_datasets();
  return entries;
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
  }
  // All together, as some depend on others; the message begins with the key that it is about.
  try {
    entry.create(setup, values);
  } catch (const InputError& error) {
    const std::string what = error.what();
    const Setting* about = settings.find(what.substr(0, what.find(':')));
    if (about == nullptr) throw;
    refuse(*about, prefix + what);
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
  if (kind == ConfigurationKind::comparison) configuration.study.describe(table);
  refuse_keys_of_other_kind(settings, kind);
  std::vector<std::string> known = table.keys();
  known.insert(known.end(), {"estimator.type", "estimators", "association.reference"});
  for (const Setting& setting : settings.all()) {
    if (!is_estimator_key(setting.key)) set(table, setting, known);
  }
  check(settings, configuration);
  const std::vector<std::string> unused =
      ignored_of_false_loops(settings, configuration.study.false_loops);
  refuse_ignored_of_false_loops(settings, configuration.study.false_loops);
  const std::vector<IgnoredKey> ignored = configuration.front_end.ignored_keys();
  refuse_ignored(settings, ignored, table);
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
  for (const Setting& setting : settings.all()) {
    configuration.origins[setting.key] = setting.origin;
  }
  for (const std::string& key : table.keys()) {
    const bool is_ignored = std::ranges::any_of(
        ignored, [&](const IgnoredKey& other) { return kFrontEnd + other.key == key; });
    if (is_ignored || std::ranges::find(unused, key) != unused.end()) continue;
    configuration.in_force.emplace_back(key, table.value(key));
  }
  return configuration;
}

std::vector<std::pair<std::string, std::string>> estimator_options(
    const EstimatorConfiguration& estimator, const EstimatorEntry& entry) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const OptionDescription& option : entry.options) {
    const auto given = estimator.values.find(option.key);
    const bool is_given = given != estimator.values.end() && !given->second.items.empty();
    options.emplace_back(option.key, is_given ? given->second.items.front() : option.default_value);
  }
  return options;
}

}  // namespace fathom
