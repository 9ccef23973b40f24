#pragma once

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// The estimators that Fathom ships.
const EstimatorRegistry& builtin_estimators();

}  // namespace fathom
