#include "apps/common.hpp"

#include <cstdio>

#include "apps/command.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {

void add_plugins_to(Command& command, std::vector<std::string>& files) {
  command.texts("--plugin", files, "FILE", "Further estimators: a shared object, or a .py file");
}

void add_drop_self_edges_to(Command& command, bool& field) {
  command.boolean("--drop-self-edges", field,
                  "Leave out edges from a pose to itself, which are refused otherwise");
}

void CommonFlags::add_settings_to(Command& command, Context& context) {
  context_ = &context;
  command.texts("--set", overrides, "KEY=VALUE",
                "Override a setting, for example estimator.type=ekf");
  add_plugins_to(command, plugins);
  command.integer("--seed", seed, Range::any(), "N", "Base seed of all noise and of RANSAC");
  command.boolean("--quiet", quiet, "No output but errors");
}

void CommonFlags::add_out_to(Command& command, const std::string& what) {
  command.text("--out", out, "DIR", what);
}

Settings CommonFlags::settings(const std::string& path) const {
  Settings settings = workflow::settings_of(path);
  for (const std::string& text : overrides) settings.put(parse_override(text));
  if (seed) settings.put({"seed", OptionValue::scalar(std::to_string(*seed)), "--seed"});
  context_->estimators().load(settings, plugins);
  return settings;
}

const EstimatorRegistry& CommonFlags::estimators() const {
  return context_->estimators().registry();
}

std::string CommonFlags::folder_or(const std::string& name) const {
  return out.empty() ? "runs/" + name : out;
}

std::unique_ptr<RegistrationStore> open_registrations(const std::filesystem::path& folder,
                                                      bool quiet) {
  auto store = std::make_unique<RegistrationStore>(folder);
  if (const std::string problem = store->problem(); !problem.empty() && !quiet) {
    std::fprintf(stderr, "fathom: note: no registration cache: %s\n", problem.c_str());
  }
  return store;
}

}  // namespace fathom
