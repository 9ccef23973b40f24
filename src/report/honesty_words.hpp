#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// Whether honesty_words looks at a metric.
bool is_of_words(const std::string& metric);

/// Whether an estimate lies so far above the optimum of the measurements that no honest one would.
/// F above it has an interval above the 97.5 % quantile of χ² of 3 degrees of freedom.
bool is_off_the_optimum(const std::map<std::string, MetricSummary>& figures);

/// What the consistency of an estimator on a cell means, in at most two sentences; none where the
/// figures are as expected or say nothing. `figures` are means over runs by metric, `draws` how
/// many independent draws they are over.
///
/// An ANEES is too high where both hold (docs/conventions.md, consistency):
/// - it is above the 95 % χ² interval of `draws` · 3 degrees of freedom, which is that of errors
///   that are the same at all keyframes, and so the widest one;
/// - its bootstrap interval, where there is one, lies above 1.
/// Too low likewise. A mean NIS against truth is held to the same interval, three times as large.
/// F per degree of freedom is held to the χ² interval of `draws` times its degrees of freedom:
/// 3 · registrations, unless `degrees_of_freedom` says otherwise.
std::vector<std::string> honesty_words(const std::map<std::string, MetricSummary>& figures,
                                       std::size_t draws);

}  // namespace fathom
