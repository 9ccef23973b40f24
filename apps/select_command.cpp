// fathom select: the back end that meets a user's requirements, from the results of a study.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "fathom/core/files.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/report/table.hpp"
#include "fathom/results/selected_config.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {
namespace {

constexpr int kDigits = 4;
constexpr const char* kConfigName = "selected.yaml";

struct SelectFlags {
  std::string results;
  std::vector<std::string> requirements;
  std::vector<std::string> where;
  std::string minimise;
  std::string maximise;
  double allowed_failures = 0.0;
  std::string out;
  bool quiet = false;
};

std::string counted(std::size_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

std::string interval_text(const std::optional<TrialMean>& value) {
  if (!value || !value->interval) return "-";
  return "[" + format_number(value->interval->low, kDigits) + ", " +
         format_number(value->interval->high, kDigits) + "]";
}

std::string mean_text(const std::optional<TrialMean>& value) {
  return value ? format_number(value->mean, kDigits) : "-";
}

SelectionQuery query_of(const SelectFlags& flags) {
  SelectionQuery query;
  for (const std::string& text : flags.requirements) {
    query.requirements.push_back(parse_requirement(text));
  }
  if (!flags.minimise.empty()) query.objective = flags.minimise;
  if (!flags.maximise.empty()) query.objective = flags.maximise;
  query.maximise = !flags.maximise.empty();
  query.where = flags.where;
  query.allowed_failures = flags.allowed_failures;
  return query;
}

// "in all 10 cells", and of which there is nothing to say.
std::string cells_text(const Selection& selection) {
  if (selection.cells.size() < selection.cells_asked) {
    return "in " + std::to_string(selection.cells.size()) + " of " +
           counted(selection.cells_asked, "cell") + ", the others without runs";
  }
  return selection.cells.size() == 1
             ? "in the one cell"
             : "in all " + std::to_string(selection.cells.size()) + " cells";
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
         cells_text(selection) + "; " + objective_text(query) + ": " + mean_text(chosen.objective) +
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
  return "no back end " +
         (count == 0 ? std::string("can be chosen")
                     : "meets " + requirements_text(count) + " " + cells_text(selection)) +
         ": " + obstacle_text(selection, query) + "; nearest is " +
         selection.estimators[selection.nearest].name;
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
    numbers = " (difference of " + query.objective + " " + format_number(difference->mean, kDigits);
    if (difference->interval) {
      numbers += " [" + format_number(difference->interval->low, kDigits) + ", " +
                 format_number(difference->interval->high, kDigits) + "]";
    }
    numbers += " over " + counted(difference->count, "run");
    if (difference->signed_rank.p_value) {
      numbers += ", Wilcoxon p " + format_number(*difference->signed_rank.p_value, 2);
    }
    numbers += ")";
  }
  return selection.lead->is_significant
             ? "better than " + other + numbers
             : "no better than " + other + " on this evidence" + numbers + "; chosen by its mean";
}

void print(const Selection& selection, const SelectionQuery& query, const StudyDescription& study) {
  std::printf(
      "%s\n",
      (selection.chosen ? chosen_text(selection, query) : none_text(selection, query)).c_str());
  if (selection.lead) std::printf("%s\n", lead_text(selection, query).c_str());
  if (!query.requirements.empty()) {
    std::printf("\n%s", requirement_table(selection, query, study).c_str());
  }
  std::printf("\n%s", objective_table(selection, query).c_str());
  if (!selection.remarks.empty()) std::printf("\n");
  for (const std::string& remark : selection.remarks) std::printf("remark: %s\n", remark.c_str());
}

std::filesystem::path folder_of(const SelectFlags& flags) {
  if (!flags.out.empty()) return flags.out;
  const std::filesystem::path results = flags.results;
  if (std::filesystem::is_directory(results)) return results;
  return results.has_parent_path() ? results.parent_path() : ".";
}

// Returns the file as the user would name it.
std::filesystem::path write_config(const SelectFlags& flags, const std::string& text) {
  try {
    StagedFolder folder(folder_of(flags), {flags.results});
    write_file(folder.path() / kConfigName, text);
    folder.commit();
    return folder_of(flags) / kConfigName;
  } catch (const InputError& error) {
    if (!flags.out.empty()) throw;
    throw InputError(std::string(error.what()) + "; --out DIR says where " + kConfigName +
                     " may be written");
  }
}

void select(const SelectFlags& flags, Context& context) {
  const SelectionQuery query = query_of(flags);
  const ResultStore store = ResultStore::open(flags.results);
  const Selection selection = select_estimator(store, query);
  std::filesystem::path config;
  if (selection.chosen) {
    config = write_config(
        flags, selected_configuration(store.study(), selection, query, builtin_estimators()));
  }
  context.status = selection.chosen ? kDone : kFailed;
  if (flags.quiet) return;
  print(selection, query, store.study());
  if (selection.chosen) {
    std::printf("\nwrote %s\nrun it with: fathom run %s\n", config.c_str(), config.c_str());
  }
}

}  // namespace

void add_select(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SelectFlags>();
  Command command(
      program, "select", "Name the back end that meets requirements, from a study",
      "Example: fathom select runs/study --require 'mean_position_error_m<=0.1'\n"
      "         --require 'update_ms.p95<=20' --minimise total_ms\n"
      "Exit status: 0 chosen, and selected.yaml for 'fathom run' written; 1 none meets; 2 bad "
      "input.");
  command.argument("results", flags->results, "Folder of a study, or its results.sqlite");
  command.texts("--require", flags->requirements, "REQUIREMENT",
                "METRIC <=, <, >= or > NUMBER, met where the 95 % interval of the mean does in "
                "every cell (repeatable)");
  const Flag minimise =
      command.text("--minimise,--minimize", flags->minimise, "METRIC",
                   "The metric that decides among those that meet all (default: total_ms)");
  command.text("--maximise,--maximize", flags->maximise, "METRIC", "Likewise; the greatest is best")
      .excludes(minimise);
  command.texts("--where", flags->where, "AXIS=LABEL",
                "Only cells of the sweep with this value of an axis (repeatable)");
  command.real("--allow-failures", flags->allowed_failures, Range::between(0.0, 1.0), "SHARE",
               "Share of a back end's runs that may have failed");
  command.text("--out", flags->out, "DIR",
               "Folder of selected.yaml (default: that of the results)");
  command.boolean("--quiet", flags->quiet, "No output but errors");
  command.on_run([flags, &context] { select(*flags, context); });
}

}  // namespace fathom
