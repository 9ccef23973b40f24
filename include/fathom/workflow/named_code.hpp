#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom::workflow {

/// Code that a configuration names, so that whoever runs it executes it. What `--set` says is the
/// user's own word, and in none of these.
struct NamedCode {
  std::vector<std::string> plugins;   ///< files under `plugins`
  std::vector<std::string> commands;  ///< `command` of estimators, those of a sweep too

  bool is_empty() const { return plugins.empty() && commands.empty(); }
};

/// Throws InputError where `plugins` is no list of words.
NamedCode named_code(const Settings& settings);

/// Adds an entry for every type of estimator in the settings that the registry does not know, as
/// one of the first of these plug-ins, which is not loaded: every key and value of it is taken as
/// it stands, and who makes such an estimator gets an InputError. Nothing where no plug-in is
/// given.
void add_unloaded(const Settings& settings, const std::vector<std::string>& plugins,
                  EstimatorRegistry& registry);

}  // namespace fathom::workflow
