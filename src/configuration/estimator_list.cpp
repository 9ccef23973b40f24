#include "estimator_list.hpp"

#include <algorithm>
#include <set>

#include "canonical_value.hpp"
#include "fathom/configuration/study_description.hpp"
#include "fathom/core/text.hpp"
#include "list_items.hpp"

namespace fathom {
namespace {

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

// Names of what every object of JavaScript has: the charts of a report keep what is drawn by name.
bool is_word_of_javascript(const std::string& name) {
  static const std::set<std::string> words{
      "__defineGetter__", "__defineSetter__", "__lookupGetter__",
      "__lookupSetter__", "__proto__",        "constructor",
      "hasOwnProperty",   "isPrototypeOf",    "propertyIsEnumerable",
      "toLocaleString",   "toString",         "valueOf"};
  return words.contains(name);
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

// No setting of the list may go unread: not one of `estimators.7` where there are three of them.
void refuse_unused_items(const Settings& settings, std::size_t count) {
  const std::string list = "estimators.";
  for (const Setting& setting : settings.all()) {
    if (!setting.key.starts_with(list) || is_item_below(setting.key, list, count)) continue;
    refuse(setting, setting.key +
                        ": expected a list of maps, such as '- {type: ekf}', numbered from 0 "
                        "without a gap");
  }
}

}  // namespace

EstimatorValues estimator_values(const Settings& settings, const EstimatorEntry& entry,
                                 const EstimatorSetup& setup, const std::string& prefix) {
  std::vector<std::string> known{prefix + "type"};
  for (const OptionDescription& option : entry.options) known.push_back(prefix + option.key);
  EstimatorValues values;
  for (const Setting& setting : settings.all()) {
    const std::string full = prefix + setting.key;
    if (std::find(known.begin(), known.end(), full) == known.end()) {
      known.push_back(prefix + "name");
      refuse(setting, "unknown key '" + full + "' of " + entry.name + suggestion(full, known));
    }
    values[setting.key] = setting.value;
  }
  // All together, as some depend on others; the message begins with the key that it is about.
  try {
    if (entry.check) {
      entry.check(setup, values);
    } else {
      entry.create(setup, values);
    }
  } catch (const InputError& error) {
    const std::string what = error.what();
    const Setting* about = settings.find(what.substr(0, what.find(':')));
    if (about == nullptr) throw;
    refuse(*about, prefix + what);
  }
  return values;
}

std::vector<std::pair<std::string, std::string>> estimator_options(
    const EstimatorConfiguration& estimator, const EstimatorEntry& entry) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const OptionDescription& option : entry.options) {
    const auto given = estimator.values.find(option.key);
    const bool is_given = given != estimator.values.end() && !given->second.items.empty();
    options.emplace_back(option.key, is_given
                                         ? canonical_text(given->second, option.type, number_text)
                                         : option.default_value);
  }
  return options;
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
  const Setting* named = settings.find("name");
  const auto refuse_name = [&](const std::string& why) {
    refuse(named == nullptr ? *settings.find("type") : *named, prefix + "name: " + why);
  };
  if (!is_plain_word(estimator.name)) {
    refuse_name("it names a folder too: letters, digits, - and _");
  }
  if (estimator.name == kDeadReckoning) {
    refuse_name("dead_reckoning is the baseline of every table");
  }
  if (estimator.name == kGroundTruth || estimator.name == kAutomatic) {
    refuse_name(estimator.name + " is a word of association.reference");
  }
  if (estimator.name == "figures" || estimator.name == "batch_optimum") {
    refuse_name(estimator.name + " is a folder of a report or of a run; give another one");
  }
  if (is_word_of_javascript(estimator.name)) {
    refuse_name(estimator.name + " means something to the page of a report; give another one");
  }
  if (prefix != "estimator.") refuse_unused(own, entry, prefix);
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
    constexpr std::size_t kMost = 1000;
    if (i == kMost) {
      refuse(own.all().front(), "estimators: has more than " + std::to_string(kMost) +
                                    " estimators, the limit of a study");
    }
    list.push_back(configure_estimator(own, registry, prefix));
    if (!names.insert(list.back().name).second) {
      refuse(own.all().front(),
             "two estimators are called '" + list.back().name + "'; give one of them another name");
    }
  }
  refuse_unused_items(settings, list.size());
  if (!list.empty()) return list;
  for (const EstimatorEntry& entry : registry.entries()) {
    if (entry.runs_program) continue;
    list.push_back({entry.name, entry.name, {}});
  }
  return list;
}

}  // namespace fathom
