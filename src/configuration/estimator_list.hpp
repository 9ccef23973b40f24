#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"

namespace fathom {

/// The estimator of a run, or an item of a list: `prefix` is what stands before its keys, for
/// example "estimators.0.". Throws InputError.
EstimatorConfiguration configure_estimator(const Settings& settings,
                                           const EstimatorRegistry& registry,
                                           const std::string& prefix);

/// The list `estimators:`; without one, every estimator with its defaults. Throws InputError.
std::vector<EstimatorConfiguration> configure_list(const Settings& settings,
                                                   const EstimatorRegistry& registry);

/// The place in the list of `association.reference`, by default the first. Throws InputError.
std::size_t find_reference(const Settings& settings,
                           const std::vector<EstimatorConfiguration>& estimators);

}  // namespace fathom
