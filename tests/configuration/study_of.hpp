#pragma once

#include <string>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/input_error.hpp"

namespace fathom::test {

inline Study study_of(const std::string& text) {
  return configure_study(settings_of(text), builtin_estimators());
}

/// Why a text is refused as a study.
inline std::string refusal_of_study(const std::string& text) {
  return input_error_of([&] { study_of(text); });
}

}  // namespace fathom::test
