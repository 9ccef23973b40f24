#pragma once

#include <string>

#include "fathom/core/forked_child.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// What became of a child that did not do all of its work, and one line that says how.
struct ChildFailure {
  Outcome outcome = Outcome::crashed;
  std::string how;
};
ChildFailure failure_of(const ChildEnd& end, const ChildLimits& limits);

}  // namespace fathom
