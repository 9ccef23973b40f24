#include "apps/common.hpp"

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "fathom/core/text.hpp"
#include "fathom/workflow/inputs.hpp"
#include "fathom/workflow/named_code.hpp"

namespace fathom {

void add_plugins_to(Command& command, std::vector<std::string>& files) {
  command.texts("--plugin", files, "FILE", "Further estimators: a shared object, or a .py file");
}

void PluginFlags::add_to(Command& command) {
  add_plugins_to(command, files);
  command.boolean("--allow-plugins", allows_named,
                  "Load the plug-ins that a configuration names, too: loading executes their code");
}

void print_named_code(const std::string& what, const workflow::NamedCode& code) {
  std::vector<std::string> names = code.plugins;
  names.insert(names.end(), code.commands.begin(), code.commands.end());
  if (!names.empty())
    print_note("the configuration names code, " + what + ": " + joined(names, "; "));
}

void load_named_code(Settings& settings, const PluginFlags& flags, workflow::NamedPlugins named,
                     workflow::KnownEstimators& estimators, bool quiet) {
  using workflow::NamedPlugins;
  workflow::NamedCode code = workflow::named_code(settings);
  if (named == NamedPlugins::loaded) {
    if (!quiet) print_named_code("which is executed", code);
  } else if (flags.allows_named) {
    named = NamedPlugins::loaded;
  } else if (!quiet) {
    code.commands.clear();
    print_named_code("which is left out (--allow-plugins loads it)", code);
  }
  estimators.load(settings, flags.files, named);
}

void add_drop_self_edges_to(Command& command, bool& field) {
  command.boolean("--drop-self-edges", field,
                  "Leave out edges from a pose to itself, which are refused otherwise");
}

void CommonFlags::add_settings_to(Command& command, Context& context) {
  context_ = &context;
  command.texts("--set", overrides, "KEY=VALUE",
                "Override a setting, for example estimator.type=ekf");
  plugins.add_to(command);
  command.integer("--seed", seed, Range::any(), "N", "Base seed of all noise and of RANSAC");
  command.boolean("--quiet", quiet, "No output but errors");
}

void CommonFlags::add_out_to(Command& command, const std::string& what) {
  command.text("--out", out, "DIR", what);
}

Settings CommonFlags::given(const std::string& path) const {
  Settings settings = workflow::settings_of(path);
  for (const std::string& text : overrides) {
    for (const Setting& one : parse_overrides(text)) settings.put(one);
  }
  if (!path.empty()) workflow::require_keys(settings, path);
  if (seed) settings.put({"seed", OptionValue::scalar(std::to_string(*seed)), "--seed"});
  return settings;
}

Settings CommonFlags::settings(const std::string& path, workflow::NamedPlugins named) const {
  Settings settings = given(path);
  load_named_code(settings, plugins, named, context_->estimators(), quiet);
  return settings;
}

const EstimatorRegistry& CommonFlags::estimators() const {
  return context_->estimators().registry();
}

std::string CommonFlags::folder_or(const std::string& name) const {
  return out.empty() ? "runs/" + name : out;
}

std::array<Flag, 2> CacheFlags::add_to(Command& command) {
  const Flag cache = command.text("--cache", folder, "DIR",
                                  "Folder of the registrations that are kept, so that no pair of "
                                  "pictures is registered twice (default: $FATHOM_CACHE, or "
                                  "~/.cache/fathom; 'fathom cache' shows it)");
  const Flag no_cache =
      command.boolean("--no-cache", is_off, "Neither read nor write kept registrations");
  no_cache.excludes(cache);
  return {cache, no_cache};
}

std::unique_ptr<RegistrationStore> CacheFlags::open(bool quiet) const {
  if (is_off) return nullptr;
  auto store =
      folder.empty() ? RegistrationStore::usual() : std::make_unique<RegistrationStore>(folder);
  if (const std::string problem = store->problem(); !problem.empty() && !quiet) {
    print_note("no registration cache: " + problem);
  }
  return store;
}

}  // namespace fathom
