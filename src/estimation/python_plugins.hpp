#pragma once

#include <filesystem>

#include "fathom/estimation/plugin.hpp"

namespace fathom {

/// Of a `.py` file. Throws InputError, one line with the file, where it cannot be read, or this
/// build has no Python.
const PluginInterface& python_interface_of(const std::filesystem::path& file);

}  // namespace fathom
