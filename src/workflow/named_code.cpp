#include "fathom/workflow/named_code.hpp"

#include <algorithm>
#include <set>

#include "fathom/core/input_error.hpp"

namespace fathom::workflow {
namespace {

// Of the key of an estimator's option: the option. "estimators.0.gain" and "estimator.gain" have
// "gain".
std::string option_in(const std::string& key) {
  if (key.starts_with("estimator.")) return key.substr(10);
  if (!key.starts_with("estimators.")) return "";
  const std::size_t dot = key.find('.', 11);
  return dot == std::string::npos ? "" : key.substr(dot + 1);
}

// Every value that an option of estimators has, as itself or along an axis of a sweep.
template <class Visit>
void for_each_value(const Settings& settings, Visit visit) {
  for (const Setting& setting : settings.all()) {
    if (const std::string option = option_in(setting.key); !option.empty()) {
      visit(option, setting, setting.value);
    }
    if (!setting.key.starts_with("sweep.") || !setting.key.ends_with(".key")) continue;
    if (setting.value.items.size() != 1) continue;
    const std::string option = option_in(setting.value.items.front());
    const std::string axis = setting.key.substr(0, setting.key.size() - 3);
    const Setting* const values = settings.find(axis + "values");
    if (option.empty() || values == nullptr) continue;
    for (const std::string& item : values->value.items) {
      visit(option, *values, OptionValue::scalar(item));
    }
  }
}

bool is_of_the_command_line(const Setting& setting) {
  return setting.origin.starts_with("--");
}

}  // namespace

NamedCode named_code(const Settings& settings) {
  NamedCode code;
  if (const Setting* const given = settings.find("plugins")) {
    if (!given->value.is_list) refuse(*given, "plugins: expected a list of files, [FILE]");
    if (!is_of_the_command_line(*given)) code.plugins = given->value.items;
  }
  std::set<std::string> commands;
  for_each_value(settings,
                 [&](const std::string& option, const Setting& from, const OptionValue& value) {
                   if (option == "command" && !is_of_the_command_line(from))
                     commands.insert(value.text());
                 });
  code.commands.assign(commands.begin(), commands.end());
  return code;
}

void add_unloaded(const Settings& settings, const std::vector<std::string>& plugins,
                  EstimatorRegistry& registry) {
  if (plugins.empty()) return;
  std::set<std::string> types;
  std::vector<OptionDescription> options;
  for_each_value(
      settings, [&](const std::string& option, const Setting&, const OptionValue& value) {
        if (option == "name") return;
        if (option == "type") {
          types.insert(value.text());
        } else if (std::ranges::find(options, option, &OptionDescription::key) == options.end()) {
          const char* const type = value.is_list ? "list of text" : "text";
          options.push_back({option, type, "", "", "", "of a plug-in that is not loaded"});
        }
      });
  for (const std::string& type : types) {
    const auto& known = registry.entries();
    if (std::ranges::find(known, type, &EstimatorEntry::name) != known.end()) continue;
    EstimatorEntry entry;
    entry.name = type;
    entry.help = "of a plug-in that is not loaded";
    entry.can_batch = true;
    entry.options = options;
    entry.plugin = plugins.front();
    entry.check = [](const EstimatorSetup&, const EstimatorValues&) {};
    entry.create = [type](const EstimatorSetup&,
                          const EstimatorValues&) -> std::unique_ptr<Estimator> {
      throw InputError("estimator '" + type +
                       "' is of a plug-in that is not loaded; --allow-plugins loads those that a "
                       "configuration names");
    };
    registry.add(std::move(entry));
  }
}

}  // namespace fathom::workflow
