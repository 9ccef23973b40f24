#pragma once

#include <string>
#include <vector>

#include "fathom/results/run_index.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {

/// The runs that are compared: the common trials of each cell looked at.
struct Compared {
  const RunIndex& runs;
  std::vector<std::size_t> asked;             ///< cells, with such a trial or not
  std::vector<std::size_t> cells;             ///< those with one
  std::vector<std::vector<TrialKey>> trials;  ///< of each of the cells
};

/// Throws InputError where no cell has such a trial.
Compared compared_runs(const RunIndex& runs, const std::vector<std::size_t>& asked);

/// An estimator's run of a trial in the c-th of the compared cells; nothing where it failed, or is
/// not there.
const RunRecord* done_run(const Compared& compared, const std::string& estimator, std::size_t c,
                          const TrialKey& trial);

/// A metric of a run that is done; nothing where it has none, or has it as a cost of another
/// processor than that of cost_machine().
std::optional<double> value_of(const Compared& compared, const RunRecord& run,
                               const std::string& metric);

/// The trials of each cell in which all of these estimators have a metric.
std::vector<std::vector<TrialKey>> trials_of_all(const Compared& compared,
                                                 const std::vector<std::string>& estimators,
                                                 const std::string& metric);

/// The mean of a metric over the cells, of these trials of each. Nothing where a cell has no value,
/// or a run that is done has none.
std::optional<TrialMean> mean_over(const Compared& compared, const std::string& estimator,
                                   const std::string& metric,
                                   const std::vector<std::vector<TrialKey>>& trials);

/// The same of what one estimator has more than another, both in all of these trials. Nothing where
/// a cell has none.
std::optional<PairedDifference> difference_over(const Compared& compared, const std::string& one,
                                                const std::string& other, const std::string& metric,
                                                const std::vector<std::vector<TrialKey>>& trials);

EstimatorEvidence evidence_of(const Compared& compared, const std::string& estimator,
                              const SelectionQuery& query);

/// How far a value reaches to the wrong side, as a share of the bound; below 0 it does not.
double excess(const Requirement& requirement, const Judgement& judgement);

/// What limits the evidence, a line each.
std::vector<std::string> remarks_on(const Compared& compared, const Selection& selection,
                                    const SelectionQuery& query);

}  // namespace fathom
