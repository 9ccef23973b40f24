#pragma once

#include <string>

namespace fathom::test {

/// A plug-in of tests/apps/plugins.
inline std::string plugin(const std::string& name) {
  return FATHOM_PLUGINS + name + ".so";
}

/// A small log, drawn.
inline constexpr const char* kLog = R"(dataset:
  type: simulated_log
  mission: {type: sweep, legs: 3, leg_length_m: 8, leg_spacing_m: 1.0}
  loops: {max_distance_m: 1.4}
)";

}  // namespace fathom::test
