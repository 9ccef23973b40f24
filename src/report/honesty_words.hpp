#pragma once

#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// Why, in a sentence; empty where it is unknown. The numbers are the `consistency` of `one`.
std::string cause_words(const EstimatorResults& one);

/// What the consistency of an estimator on a cell means, in at most two sentences; none where it is
/// as expected or not known.
std::vector<std::string> honesty_words(const EstimatorResults& one);

}  // namespace fathom
