#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace fathom {

/// What a YAML text may hold, so that reading it takes little time and memory: far more than any
/// configuration or `sensor.yaml` has (docs/formats.md). What an alias repeats counts every time.
inline constexpr std::size_t kMostYamlBytes = 4'000'000;
inline constexpr std::size_t kMostYamlNodes = 200'000;  ///< scalars, lists and maps
inline constexpr std::size_t kDeepestYaml = 32;         ///< maps and lists in each other

struct YamlExcess {
  std::size_t line = 0;  ///< from 1
  std::string what;      ///< the limit, and what would be right
};

/// Where a text goes beyond a limit, if it does; nothing is built on the way there. Of a text that
/// is no YAML: up to its fault, which is the parser's to tell unless it would never end there.
std::optional<YamlExcess> yaml_excess(const std::string& text);

/// Throws InputError with file and line where the text of a file goes beyond a limit.
void require_yaml_within_limits(const std::string& text, const std::string& file);

}  // namespace fathom
