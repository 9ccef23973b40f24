#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "selection_evidence.hpp"

namespace fathom {
namespace {

// Whether any metric that the query asks for has a property.
template <class Property>
bool asks_for(const SelectionQuery& query, Property property) {
  const auto has = [&property](const std::string& name) {
    const auto metric = find_metric(name);
    return metric && property(*metric);
  };
  return has(query.objective) ||
         std::any_of(query.requirements.begin(), query.requirements.end(),
                     [&has](const Requirement& needed) { return has(needed.metric); });
}

// Where errors of cells were made after different alignments.
std::string alignments_remark(const StudyDescription& study,
                              const std::vector<std::size_t>& cells) {
  std::set<std::string> alignments;
  for (const std::size_t cell : cells) alignments.insert(study.alignment_of(cell));
  if (alignments.size() < 2) return "";
  std::string text;
  for (const std::string& alignment : alignments) text += (text.empty() ? "" : ", ") + alignment;
  return "the cells have errors after different alignments (" + text +
         "), which are no one quantity: --where leaves cells of one";
}

// What intervals over the trials of one set of pictures do not say.
std::string one_survey_remark(const Compared& compared, const Selection& selection) {
  if (selection.surveys > 1 || selection.most_trials < 2) return "";
  std::set<std::string> remarks;
  for (const std::size_t cell : selection.cells) {
    remarks.insert(limits_of_one_survey(compared.runs.study().repetition_of(cell)));
  }
  remarks.erase("");
  return remarks.empty() ? "" : *remarks.begin();
}

// Of the c-th compared cell: the runs of an estimator that are done, and of these those that lack a
// metric, and those whose value counts.
struct Measured {
  std::size_t done = 0;
  std::size_t without = 0;
  std::size_t with = 0;
};

Measured measured(const Compared& compared, const std::string& estimator, std::size_t c,
                  const std::string& metric) {
  Measured count;
  for (const TrialKey& trial : compared.trials[c]) {
    const RunRecord* run = done_run(compared, estimator, c, trial);
    if (run == nullptr) continue;
    ++count.done;
    count.without += run->metrics.contains(metric) ? 0 : 1;
    count.with += value_of(compared, *run, metric) ? 1 : 0;
  }
  return count;
}

// "in noise 2 m "; of a study of one cell empty.
std::string in_cell(const Compared& compared, std::size_t cell) {
  const StudyDescription& study = compared.runs.study();
  return study.cell_count() == 1 ? "" : "in " + study.label_of(cell) + " ";
}

// Why one without an objective, or without trials that the others have, is passed over.
std::string passed_over_text(const Compared& compared, const EstimatorEvidence& evidence,
                             const std::string& objective) {
  if (evidence.shares_nothing_in) {
    return fmt::format(
        "{}: {}it has {} in no trial that the others have it in, so it cannot be chosen",
        evidence.name, in_cell(compared, *evidence.shares_nothing_in), objective);
  }
  if (evidence.objective) return "";
  Measured all;
  std::string bare;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    const Measured one = measured(compared, evidence.name, c, objective);
    all.done += one.done;
    all.without += one.without;
    if (one.with == 0 && bare.empty()) bare = in_cell(compared, compared.cells[c]);
  }
  if (all.without > 0) {
    return fmt::format("{}: {} was not measured in {} of {}, so it cannot be chosen", evidence.name,
                       objective, all.without, counted(all.done, "run"));
  }
  if (evidence.has_too_many_failures) return "";
  return fmt::format("{}: {}no run that is done has a {} to compare, so it cannot be chosen",
                     evidence.name, bare, objective);
}

// Of several trials one is left to judge by: where its other runs of a cell failed.
std::string single_run_text(const Compared& compared, const EstimatorEvidence& evidence,
                            const SelectionQuery& query) {
  std::vector<std::string> metrics{query.objective};
  for (const Requirement& needed : query.requirements) metrics.push_back(needed.metric);
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    if (compared.trials[c].size() < 2) continue;
    for (const std::string& metric : metrics) {
      if (measured(compared, evidence.name, c, metric).with != 1) continue;
      return fmt::format(
          "{}: {}one run is left, which is no evidence: its value itself was compared",
          evidence.name, in_cell(compared, compared.cells[c]));
    }
  }
  return "";
}

// Cells whose trials all have the same measurements. Loops that are held out are drawn even there.
std::string repeats_remark(const Compared& compared) {
  std::size_t cells = 0;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    bool is_one = compared.trials[c].size() > 1;
    for (const StudyEstimator& estimator : compared.runs.study().estimators) {
      std::set<std::string> logs;
      for (const auto& [trial, run] : compared.runs.of(estimator.name, compared.cells[c])) {
        logs.insert(run->log_hash);
      }
      is_one = is_one && logs.size() == 1 && !logs.contains("");
    }
    cells += is_one ? 1 : 0;
  }
  if (cells == 0) return "";
  return fmt::format(
      "the trials of {} have the same measurements: what they say alike is one result",
      counted(cells, "cell"));
}

}  // namespace

std::vector<std::string> remarks_on(const Compared& compared, const Selection& selection,
                                    const SelectionQuery& query) {
  const std::vector<std::size_t>& asked = compared.asked;
  std::vector<std::string> remarks;
  if (std::string gaps = compared.runs.unfinished(asked); !gaps.empty()) {
    remarks.push_back(std::move(gaps));
  }
  if (selection.cells.size() < asked.size()) {
    remarks.push_back(fmt::format(
        "{} of {} cells have no trial that all estimators have run: nothing is said of them",
        asked.size() - selection.cells.size(), asked.size()));
  }
  if (selection.fewest_shared == 1) {
    remarks.emplace_back(
        "one trial is no evidence: a cell with one has no interval, its value itself was compared");
  }
  if (const std::string one = one_survey_remark(compared, selection); !one.empty()) {
    remarks.push_back(one);
  }
  for (const EstimatorEvidence& evidence : selection.estimators) {
    if (evidence.failed == 0) continue;
    remarks.push_back(fmt::format("{}: {} of {} runs failed and are left out of its means{}",
                                  evidence.name, evidence.failed, evidence.runs,
                                  evidence.has_too_many_failures ? "; it is out for that" : ""));
    const std::string single = single_run_text(compared, evidence, query);
    if (!evidence.has_too_many_failures && !single.empty()) remarks.push_back(single);
  }
  if (selection.trials_left_out > 0) {
    remarks.push_back(
        fmt::format("{} is compared without {}, which not all that meet the requirements have",
                    query.objective, counted(selection.trials_left_out, "trial")));
  }
  for (const EstimatorEvidence& evidence : selection.estimators) {
    const std::string passed = passed_over_text(compared, evidence, query.objective);
    if (!passed.empty()) remarks.push_back(passed);
  }
  if (const std::string repeated = repeats_remark(compared); !repeated.empty()) {
    remarks.push_back(repeated);
  }
  const auto is_aligned = [](const Metric& metric) { return metric.is_aligned; };
  const std::string alignments = alignments_remark(compared.runs.study(), selection.cells);
  if (!alignments.empty() && asks_for(query, is_aligned)) remarks.push_back(alignments);
  const auto is_cost = [](const Metric& metric) { return metric.is_cost; };
  if (const int jobs = compared.runs.most_jobs(selection.cells);
      jobs > 1 && asks_for(query, is_cost)) {
    remarks.push_back("measured with " + std::to_string(jobs) +
                      " jobs at a time: costs are comparable at 1 alone");
  }
  const auto& machines = compared.runs.machines();
  if (machines.size() > 1 && asks_for(query, is_cost)) {
    const std::string& machine = compared.runs.cost_machine();
    remarks.push_back(fmt::format(
        "runs are from {} kinds of processor: costs are those of {} alone, {} runs of the study",
        machines.size(), machine.empty() ? "an unknown one" : machine, machines.at(machine)));
  }
  return remarks;
}

}  // namespace fathom
