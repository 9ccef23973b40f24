#pragma once

#include <string>

#include "fathom/estimation/registry.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {

/// A configuration for `fathom run` (YAML) of the estimator that was chosen, with the data set's
/// and the front end's values of the study as far as they are no defaults. A swept key has its
/// value of the cells looked at; where they have several, the first of these, with a comment. Keys
/// that only a comparison has are left out.
/// Throws InputError unless an estimator was chosen, and on a type that the registry has not.
std::string selected_configuration(const StudyDescription& study, const Selection& selection,
                                   const SelectionQuery& query, const EstimatorRegistry& registry);

}  // namespace fathom
