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

/// Whether a key is `association.reference` or one below it.
bool is_reference_key(const std::string& key);

/// What `association.reference` says: `ground_truth`, `automatic` (the default), the name of one of
/// these estimators, or a map with the type and the options of another. Throws InputError.
CandidateReference configure_reference(const Settings& settings,
                                       const std::vector<EstimatorConfiguration>& estimators,
                                       const EstimatorRegistry& registry);

/// Adds a reference beside which nothing is left to select; another cell of a sweep may have a use.
void add_unused_references(const Settings& settings, const Configuration& configuration,
                           std::vector<UnusedSetting>& unused);

}  // namespace fathom
