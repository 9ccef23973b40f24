#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fathom/evaluation/metrics.hpp"
#include "fathom/evaluation/paired.hpp"
#include "fathom/evaluation/statistics.hpp"
#include "fathom/results/result_store.hpp"
#include "honesty.hpp"

namespace fathom {

/// A metric over the trials of one cell that were done and have it.
struct MetricSummary {
  Moments moments;          ///< of the trials, but for the mean: that of the surveys' means, of
                            ///< DistinctValues
  std::size_t surveys = 0;  ///< that these trials are of
  std::optional<Interval> interval;  ///< 95 %, of the mean; nothing of a single trial
};

/// All runs of one estimator, or of dead reckoning, on one cell.
struct EstimatorResults {
  std::string name;
  std::string cost_machine;     ///< the processor whose runs figures of cost are over
  std::vector<RunRecord> runs;  ///< in order of survey and trial
  std::size_t done = 0;
  std::map<std::string, std::size_t> outcomes;
  std::map<std::string, MetricSummary> metrics;
  std::optional<Honesty> honesty = std::nullopt;
  /// The figures that it is found from, whether the study reports them or not.
  std::map<std::string, MetricSummary> consistency = {};
  bool considers_shared_errors = false;  ///< StudyDescription's

  std::size_t failures() const { return runs.size() - done; }
};

/// Another estimator minus the first, over the trials that both did; of several surveys over the
/// surveys' mean differences.
struct PairedResult {
  std::string estimator;
  std::string metric;
  PairedDifference difference;
  std::optional<double> holm_p;  ///< adjusted over the tests of the cell; nothing without a test
};

struct CellResults {
  std::size_t cell = 0;
  std::string label;
  std::string association;  ///< empty where the study names none
  std::string selected_by;  ///< what selected the loops of all; empty where the study names none
  bool contender_selects = false;  ///< whether that is one of those that are compared
  std::string alignment;           ///< of its errors; empty where the study names none
  std::set<int> jobs;
  std::string machines;  ///< machines_text of the study
  Repetition repetition = Repetition::surveys;
  std::size_t surveys = 0;                   ///< that have any run
  std::size_t trials = 0;                    ///< likewise, of all surveys
  std::string repeats;                       ///< repeats_there
  std::vector<EstimatorResults> estimators;  ///< dead reckoning first, then as in the study
  std::vector<PairedResult> paired;          ///< of the study's metrics
};

/// The trials of an estimator that are done and have a metric.
std::set<TrialKey> trials_with(const EstimatorResults& one, const std::string& metric);

/// A metric that an estimator has in all of these trials, one or more.
double mean_over(const EstimatorResults& one, const std::string& metric,
                 const std::set<TrialKey>& trials);
MetricSummary summary_over(const EstimatorResults& one, const std::string& metric,
                           const std::set<TrialKey>& trials);

/// A metric of one minus that of another, or a multiple of it, over the trials that both did and
/// that have it, of `trials` alone where given; nothing where there is no such trial.
std::optional<PairedDifference> difference_between(const EstimatorResults& one,
                                                   const EstimatorResults& other,
                                                   const std::string& metric,
                                                   const BootstrapOptions& options = {},
                                                   double times = 1.0,
                                                   const std::set<TrialKey>* trials = nullptr);

/// The test of these differences alone, without their interval.
std::optional<SignedRankTest> test_between(const EstimatorResults& one,
                                           const EstimatorResults& other, const std::string& metric,
                                           const std::set<TrialKey>* trials = nullptr);

/// What all tables, charts and figures are made from; the intervals are computed once, here.
struct StudyResults {
  StudyDescription study;
  std::map<std::string, std::size_t> machines;  ///< runs by kind of processor
  std::string cost_machine;                     ///< the one whose runs figures of cost are over
  std::vector<CellResults> cells;               ///< those with runs
  std::vector<std::string> empty_cells;         ///< labels of the others
  std::vector<std::string> metrics;  ///< all that occur: the study's in its order, then by name
};

/// A metric as the catalogue has it. One that it does not know, of a store of another version, has
/// its name for a label.
Metric described(const std::string& metric);

/// Which metrics are worked up: their intervals are what takes time. With none there are the runs
/// and how they ended.
enum class MetricsOf { none, study, runs };

/// Figures of cost are over the runs of `machine`; without it, of the one that has most. Throws
/// InputError on a store without runs.
StudyResults study_results(const ResultStore& store, MetricsOf metrics = MetricsOf::runs,
                           const std::optional<std::string>& machine = std::nullopt);

/// The same with the costs of each of the other kinds of processor.
std::vector<StudyResults> results_of_other_machines(const ResultStore& store,
                                                    const StudyResults& results,
                                                    MetricsOf metrics = MetricsOf::runs);

/// Whose costs are shown where runs are from several kinds of processor, a sentence; else empty.
std::string machines_text(const StudyResults& results);

/// "98/100 done, 2 diverged"; also those at the iteration limit, without loops and yet to run.
std::string outcome_text(const EstimatorResults& estimator, const StudyDescription& study);

/// "2", or "1, 4" where they differ.
std::string counts_text(const std::set<int>& jobs);

/// "separation 5: association own, alignment origin, 10 surveys × 10 trials, jobs 2"; what is
/// unknown is left out.
std::string cell_caption(const CellResults& cell);

/// Its parts without the label.
std::vector<std::string> caption_parts(const CellResults& cell);

/// The repeats that a study wants of a cell: "10 surveys × 10 trials", and where some are yet to
/// run
/// "(37 of 100)".
std::string repeats_there(const StudyDescription& study, const CellResults& cell);

/// The repeats of some cells, "1 survey × 10 trials"; all that occur where they differ.
std::string repeats_of(const std::vector<const CellResults*>& cells);

/// How means and intervals of these results are made: a sentence or two, without a line break;
/// empty where no cell has two trials.
std::string intervals_text(const StudyResults& results);

/// What the intervals of a cell do not speak of, a sentence; empty where they speak of all.
std::string limits_text(const CellResults& cell);

/// The lowest trial of the lowest survey, which is drawn.
TrialKey first_trial(const CellResults& cell);

/// "survey 0, trial 0"; where surveys are not drawn, the trial alone.
std::string example_text(const CellResults& cell, const TrialKey& trial);

/// "; failed: ekf 2/30", what a mean over the cell leaves out; empty where nothing failed.
std::string failures_text(const CellResults& cell);

/// Runs that are done and closed no loop; dead reckoning has none to lack.
std::size_t runs_without_loops(const EstimatorResults& estimator);

/// "numerical failure" for numerical_failure.
std::string worded(std::string name);

/// "dead reckoning" for kDeadReckoning, else the name.
std::string display_name(const std::string& estimator);

}  // namespace fathom
