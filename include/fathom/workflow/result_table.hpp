#pragma once

#include <string>
#include <vector>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"

namespace fathom::workflow {

/// One line an estimator, dead reckoning first, with the metrics that a terminal has room for.
std::string result_table(const Recording& recording, const std::vector<Result>& results);

}  // namespace fathom::workflow
