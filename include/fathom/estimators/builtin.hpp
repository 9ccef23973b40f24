#pragma once

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// The estimators that Fathom ships.
const EstimatorRegistry& builtin_estimators();

/// The estimator `command`, whose options name the program that does the work. It is in a registry
/// where somebody puts it.
EstimatorEntry command_entry();

}  // namespace fathom
