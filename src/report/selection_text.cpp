#include "fathom/report/selection_text.hpp"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <vector>

#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "verdict.hpp"

namespace fathom {
namespace {

constexpr int kSelectionDigits = 4;

std::string interval_text(const std::optional<TrialMean>& value) {
  if (!value || !value->interval) return "-";
  return fmt::format("[{}, {}]", format_number(value->interval->low, kSelectionDigits),
                     format_number(value->interval->high, kSelectionDigits));
}

std::string mean_text(const std::optional<TrialMean>& value) {
  return value ? format_number(value->mean, kSelectionDigits) : "-";
}

// "in all 10 cells", of what is judged together "over all 10 cells together", and of which there is
// nothing to say.
std::string cells_text(const Selection& selection, bool is_together) {
  const std::string in = is_together ? "over" : "in";
  const std::string together = is_together ? " together" : "";
  if (selection.cells.size() < selection.cells_asked) {
    return fmt::format("{} {} of {}{}, the others without runs", in, selection.cells.size(),
                       counted(selection.cells_asked, "cell"), together);
  }
  return selection.cells.size() == 1
             ? "in the one cell"
             : fmt::format("{} all {} cells{}", in, selection.cells.size(), together);
}

std::string requirements_text(std::size_t count) {
  return count == 1 ? "the requirement" : "all " + counted(count, "requirement");
}

std::string objective_text(const SelectionQuery& query) {
  return (query.maximise ? "greatest " : "least ") + query.objective;
}

std::string chosen_text(const Selection& selection, const SelectionQuery& query) {
  const EstimatorEvidence& chosen = selection.estimators[*selection.chosen];
  const std::size_t count = query.requirements.size();
  return chosen.name + (count == 0 ? " is best " : " meets " + requirements_text(count) + " ") +
         cells_text(selection, count == 0) + "; " + objective_text(query) + ": " +
         mean_text(chosen.objective) +
         (chosen.objective->interval ? " " + interval_text(chosen.objective) : "");
}

// Why nobody was chosen.
std::string obstacle_text(const Selection& selection, const SelectionQuery& query) {
  std::string unmet;
  for (const std::size_t r : selection.met_by_none) {
    unmet += (unmet.empty() ? "" : ", nor ") + query.requirements[r].text();
  }
  if (!unmet.empty()) return "none meets " + unmet;
  for (const EstimatorEvidence& evidence : selection.estimators) {
    if (evidence.meets_all) return query.objective + " was not measured of those that meet them";
  }
  std::string failing;
  for (const EstimatorEvidence& evidence : selection.estimators) {
    const bool would_meet =
        std::all_of(evidence.judgements.begin(), evidence.judgements.end(),
                    [](const Judgement& one) { return one.verdict == Verdict::meets; });
    if (would_meet) failing += (failing.empty() ? "" : ", ") + evidence.name;
  }
  return failing.empty() ? "each is met by some, all of them by none"
                         : "failed runs put out " + failing + " (--allow-failures)";
}

std::string none_text(const Selection& selection, const SelectionQuery& query) {
  const std::size_t count = query.requirements.size();
  return fmt::format("no back end {}: {}; nearest is {}",
                     count == 0
                         ? "can be chosen"
                         : "meets " + requirements_text(count) + " " + cells_text(selection, false),
                     obstacle_text(selection, query), selection.estimators[selection.nearest].name);
}

std::vector<const EstimatorEvidence*> rows_of(const Selection& selection) {
  std::vector<const EstimatorEvidence*> rows;
  for (const EstimatorEvidence& evidence : selection.estimators) rows.push_back(&evidence);
  if (selection.baseline) rows.push_back(&*selection.baseline);
  return rows;
}

std::string requirement_table(const Selection& selection, const SelectionQuery& query,
                              const StudyDescription& study) {
  Table table({"estimator", "requirement", "verdict", "mean", "95 % interval", "worst cell"});
  for (const EstimatorEvidence* evidence : rows_of(selection)) {
    for (std::size_t r = 0; r < query.requirements.size(); ++r) {
      const Judgement& judgement = evidence->judgements[r];
      table.add_row({evidence->name, query.requirements[r].text(), name_of(judgement.verdict),
                     mean_text(judgement.value), interval_text(judgement.value),
                     study.label_of(judgement.cell)});
    }
  }
  return table.text();
}

std::string standing_of(const Selection& selection, const EstimatorEvidence& evidence) {
  if (&evidence == (selection.baseline ? &*selection.baseline : nullptr)) return "baseline";
  if (selection.chosen && &evidence == &selection.estimators[*selection.chosen]) return "chosen";
  if (evidence.has_too_many_failures) return "out: failed runs";
  if (evidence.shares_nothing_in) return "out: no common trial";
  return evidence.meets_all ? "meets all" : "out";
}

std::string objective_table(const Selection& selection, const SelectionQuery& query) {
  Table table({"estimator", query.objective, "95 % interval", "runs", "failed", ""});
  for (const EstimatorEvidence* evidence : rows_of(selection)) {
    table.add_row({evidence->name, mean_text(evidence->objective),
                   interval_text(evidence->objective), std::to_string(evidence->runs),
                   std::to_string(evidence->failed), standing_of(selection, *evidence)});
  }
  return table.text();
}

std::string lead_text(const Selection& selection, const SelectionQuery& query) {
  const std::string& other = selection.estimators[selection.lead->runner_up].name;
  const auto& difference = selection.lead->difference;
  std::string numbers;
  if (difference) {
    numbers = fmt::format(" (difference of {} {}", query.objective,
                          format_number(difference->mean, kSelectionDigits));
    if (difference->interval) {
      numbers += " [" + format_number(difference->interval->low, kSelectionDigits) + ", " +
                 format_number(difference->interval->high, kSelectionDigits) + "]";
    }
    numbers +=
        " over " + counted(difference->count, difference->is_over_surveys ? "survey" : "run");
    if (difference->signed_rank.p_value) {
      numbers += ", Wilcoxon p " + format_number(*difference->signed_rank.p_value, 2);
      if (difference->mean != 0.0 && !difference->is_on_one_side()) {
        numbers += " of ranks that favour " + other;
      }
    }
    numbers += ")";
  }
  return selection.lead->is_significant
             ? "better than " + other + numbers
             : "no better than " + other + " on this evidence" + numbers + "; chosen by its mean";
}

}  // namespace

std::string selection_text(const Selection& selection, const SelectionQuery& query,
                           const StudyDescription& study) {
  std::string text =
      (selection.chosen ? chosen_text(selection, query) : none_text(selection, query)) + "\n";
  if (selection.lead) text += lead_text(selection, query) + "\n";
  text += "evidence in each cell: " + selection.repeats + "\n";
  if (!query.requirements.empty()) text += "\n" + requirement_table(selection, query, study);
  text += "\n" + objective_table(selection, query);
  if (!selection.remarks.empty()) text += "\n";
  for (const std::string& remark : selection.remarks) text += "remark: " + remark + "\n";
  return text;
}

}  // namespace fathom
