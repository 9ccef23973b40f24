#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/paired.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

// Of a metric on a cell, as the tables have it: over runs that were done, of several surveys over
// the surveys, of costs over the runs of one kind of processor. Nothing where there is none.

/// The 95 % interval of an estimator's mean.
std::optional<Interval> study_interval(const ResultStore& store, const std::string& metric,
                                       const std::string& estimator, std::size_t cell);

/// One estimator minus another, over the trials that both did; its p-value is not adjusted, and
/// absent of a single draw.
std::optional<PairedDifference> study_difference(const ResultStore& store,
                                                 const std::string& metric, const std::string& one,
                                                 const std::string& other, std::size_t cell);

}  // namespace fathom
