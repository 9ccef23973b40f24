#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"

namespace fathom {

/// The keys that say how estimators are found and run: `plugins` and those of IsolationOptions.
void bind_runs(Configuration& configuration, OptionTable& table);

/// Whether one of them has no effect: there are no plug-ins, or no run has a process of its own.
/// False of every other key.
bool is_run_key_without_effect(const std::string& key, const Configuration& configuration,
                               const EstimatorRegistry& registry);

/// Adds limits that are given for processes that there are not.
void add_unused_limits(const Settings& settings, const Configuration& configuration,
                       const EstimatorRegistry& registry, std::vector<UnusedSetting>& unused);

/// Throws InputError where an estimator that has a process of its own selects the loop candidates
/// of a study: it would run beside the front end, in this one.
void check_selection_isolated(const Settings& settings, const Configuration& configuration,
                              const EstimatorRegistry& registry);

}  // namespace fathom
