#pragma once

#include <string>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/input_error.hpp"

namespace fathom::test {

inline constexpr auto kSingle = ConfigurationKind::single;
inline constexpr auto kComparison = ConfigurationKind::comparison;

inline Configuration configured(const std::string& text, ConfigurationKind kind = kSingle) {
  return configure(settings_of(text), kind, builtin_estimators());
}

/// Why a text is refused as a configuration.
inline std::string refusal(const std::string& text, ConfigurationKind kind = kSingle) {
  return input_error_of([&] { configured(text, kind); });
}

/// The value of a key in force; "(none)" where the configuration has no such key.
inline std::string in_force(const Configuration& configuration, const std::string& key) {
  for (const auto& [known, value] : configuration.in_force) {
    if (known == key) return value;
  }
  return "(none)";
}

}  // namespace fathom::test
