#pragma once

#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom {

// The estimators of this process: built in, of FATHOM_PLUGIN_PATH, and of plug-ins loaded since.
// From any thread, without the interpreter's lock, which a plug-in in Python takes as it is read.

EstimatorRegistry known_estimators_now();
void load_plugins(const std::vector<std::string>& files);
/// Those that the settings name, and these (KnownEstimators).
void load_plugins(Settings& settings, const std::vector<std::string>& files);

}  // namespace fathom
