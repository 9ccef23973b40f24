#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/statistics.hpp"

namespace fathom {

/// One figure over the trials of several surveys: by survey the values of its trials, one or more.
/// Trials of one survey share its pictures, so their values are no independent draws: surveys are.
using ClusteredValues = std::map<std::size_t, std::vector<double>>;

/// The means of the surveys, in their order.
std::vector<double> survey_means(const ClusteredValues& values);

/// The mean of the surveys' means: each survey counts the same, however many of its trials have a
/// value. Of a single survey the mean of its trials. There must be a survey (asserted).
double clustered_mean(const ClusteredValues& values);

/// Interval of `clustered_mean` by a hierarchical bootstrap: surveys are resampled with
/// replacement, and of each that is drawn its trials; BCa with the jackknife over surveys.
///
/// Resampling at both levels counts the spread within surveys twice, as the surveys' means have it
/// already. Their deviations are therefore shrunk (Davison and Hinkley 1997, section 3.8) so that
/// the replicates have the variance of the surveys' means over their number, or that of the trials
/// within them where this is more.
///
/// Both ends are moved away from the mean as those of `bootstrap_interval`, by the number of
/// surveys.
///
/// Of a single survey it is `bootstrap_interval` of its trials. Nothing of fewer than two values.
/// Throws InputError as that function does.
std::optional<Interval> hierarchical_interval(const ClusteredValues& values,
                                              const BootstrapOptions& options = {});

/// The same of the mean over cells of their means, where surveys are common to the cells: survey s
/// of each cell is drawn together with that of the others, as it may have the same floor. A survey
/// may be missing in some cells. Nothing where a cell has a single survey or value while another
/// has several surveys: its spread is not known. There must be two surveys in all (asserted).
std::optional<Interval> interval_over_cells(std::span<const ClusteredValues> cells,
                                            const BootstrapOptions& options = {});

/// The same of cells whose values are independent draws: those of each cell are resampled by
/// themselves (a stratified bootstrap, BCa). Both ends are moved as those of `bootstrap_interval`,
/// with the degrees of freedom of a sum of variances (Satterthwaite 1946). Nothing where a cell has
/// fewer than two values.
std::optional<Interval> stratified_interval(std::span<const std::vector<double>> cells,
                                            const BootstrapOptions& options = {});

}  // namespace fathom
