#pragma once

#include <cstddef>
#include <filesystem>

#include <yaml-cpp/yaml.h>

namespace fathom {

/// From 1; of a node that has no place 1.
std::size_t line_of(const YAML::Mark& mark);

/// A `sensor.yaml`, which may be empty. Throws InputError with file and line: on what is no YAML or
/// beyond its limits, and on a key that is given twice, of which the parser would take the first.
YAML::Node yaml_root(const std::filesystem::path& path);

}  // namespace fathom
