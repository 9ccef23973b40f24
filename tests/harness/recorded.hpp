#pragma once

#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom::test {

/// What the front end makes of a survey, with the estimators of this project.
inline Recording recorded(const Configuration& configuration) {
  return record(configuration, builtin_estimators());
}

}  // namespace fathom::test
