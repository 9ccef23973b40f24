#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom {

class Command;

/// The estimators that this program knows: those built in, those of the plug-ins that
/// FATHOM_PLUGIN_PATH names, and those loaded since.
const EstimatorRegistry& estimators();

/// A copy of these, for whoever shares them with threads that load plug-ins.
EstimatorRegistry known_estimators_now();

/// Loads plug-ins; what is loaded already stays as it is. Throws InputError, also where the content
/// of such a file has changed since.
void load_plugins(const std::vector<std::string>& files);

/// --plugin FILE of a command, each use adds one.
void add_plugins_to(Command& command, std::vector<std::string>& files);

/// The files of `plugins` in a configuration and of --plugin, which are put there. Throws
/// InputError at the setting where it is no list of words.
void load_plugins(Settings& settings, const std::vector<std::string>& files);

/// The data of a study or a run, and the plug-ins and programs that do the work of these.
Fingerprint with_code(Fingerprint data, const std::vector<EstimatorConfiguration>& all,
                      const EstimatorRegistry& registry);

/// All that may run in these: those that are compared, and those that select loop candidates.
std::vector<EstimatorConfiguration> estimators_in(const std::vector<Configuration>& cells);

}  // namespace fathom
