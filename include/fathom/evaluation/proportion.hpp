#pragma once

#include <cstddef>

#include "fathom/evaluation/interval.hpp"

namespace fathom {

/// The score interval of a proportion, `successes` of `count` independent trials (Wilson 1927):
/// also good for few trials and for proportions near 0 and 1. Without trials [0, 1]. Throws
/// InputError with more successes than trials and unless 0 < probability < 1.
Interval wilson_interval(std::size_t successes, std::size_t count, double probability = 0.95);

/// The exact one-sided upper bound of a proportion (Clopper and Pearson 1934): the p at which so
/// few successes or fewer have the probability 1 − `probability`. 1 − (1 − probability)^(1/count)
/// for none; 1 where all succeeded, and without trials. Throws as wilson_interval.
double clopper_pearson_upper(std::size_t successes, std::size_t count, double probability = 0.95);

}  // namespace fathom
