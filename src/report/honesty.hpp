#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace fathom {

struct CellResults;
struct MetricSummary;

/// Why covariances do not fit the errors, by the figure that says most.
enum class HonestyCause {
  unknown,
  off_the_optimum,      ///< the estimate is not where the measurements put it
  first_picture,        ///< with other keyframes held it is honest
  shared_errors,        ///< of registrations, which the estimator does not estimate
  small_registrations,  ///< covariances of registrations are too small, or loops are false
  linearisation,        ///< they are right, the estimator's own are too small
  misfit,               ///< covariances of the log are too small, or loops are false
  large_registrations,  ///< covariances of registrations are too large
  holes                 ///< the declared covariances of guesses may be part of it
};

/// An estimator whose covariances do not fit its errors.
struct Honesty {
  bool is_overconfident = true;  ///< else underconfident
  HonestyCause cause = HonestyCause::unknown;
  /// Of an overconfident one, whether its registrations agree with one another better than their
  /// covariances say, and whether those of one picture are correlated.
  bool agrees_too_well = false;
  bool is_correlated = false;
  /// Whether the log tells what registrations share, and whether the estimator estimates it.
  bool is_told = false;
  bool estimates_shared_errors = false;
};

/// Whether honesty_of looks at a metric.
bool is_of_honesty(const std::string& metric);

/// F per degree of freedom at the optimum, of the log alone; nothing where it is not known.
std::optional<double> optimum_per_degree(const std::map<std::string, MetricSummary>& figures);

/// The least of its estimators: one that estimates what registrations share has an F of its own.
std::optional<double> optimum_per_degree(const CellResults& cell);

/// Whether measurements with so much F per degree of freedom at their optimum do not fit each
/// other, far beyond chance: then that optimum holds false loops, or covariances that are too
/// small, and says nothing of an estimate.
inline bool is_misfit(std::optional<double> per_degree) {
  return per_degree.value_or(0.0) > 3.0;
}

/// Whether an estimate lies so far above the optimum of the measurements that no honest one would.
/// F above it has an interval or a median above the 97.5 % quantile of χ² of 3 degrees of freedom.
/// No of a single trial, and where the measurements disagree. One that considers errors that
/// registrations share minimises no F: it is off beyond all that its gains explain, three per
/// degree of freedom.
bool is_off_the_optimum(const std::map<std::string, MetricSummary>& figures,
                        bool considers_shared_errors = false);

/// Whether the consistency of an estimator on a cell is other than expected; nothing where it is as
/// expected, or the figures say nothing. `figures` are means over runs by metric, `draws` how many
/// independent draws they are over.
///
/// An ANEES is too high where both hold (docs/conventions.md, consistency):
/// - it is above the 95 % χ² interval of `draws` · 3 degrees of freedom, which is that of errors
///   that are the same at all keyframes, and so the widest one;
/// - its bootstrap interval, where there is one, lies above 1.
/// Too low likewise. A mean NIS against truth is held to the same interval, three times as large.
/// F per degree of freedom is held to the χ² interval of `draws` times its degrees of freedom:
/// 3 · registrations, unless `degrees_of_freedom` says otherwise. `considers_shared_errors` as of
/// is_off_the_optimum.
std::optional<Honesty> honesty_of(const std::map<std::string, MetricSummary>& figures,
                                  std::size_t draws, bool considers_shared_errors = false);

}  // namespace fathom
