// fathom select: the back end that meets a user's requirements, from the results of a study.

#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/workflow/select.hpp"

namespace fathom {
namespace {

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

// The least ANEES is that of the most underconfident one.
void require_direction(const std::string& flag, const std::string& metric) {
  const auto known = find_metric(metric);
  if (!known || known->better != Better::neither) return;
  throw InputError(flag + " " + metric + ": neither more nor less of '" + metric +
                   "' is better; it can be required, as in --require '" + metric + "<=NUMBER'");
}

SelectionQuery query_of(const SelectFlags& flags) {
  SelectionQuery query;
  for (const std::string& text : flags.requirements) {
    query.requirements.push_back(parse_requirement(text));
  }
  if (!flags.minimise.empty()) query.objective = flags.minimise;
  if (!flags.maximise.empty()) query.objective = flags.maximise;
  if (!flags.minimise.empty()) require_direction("--minimise", flags.minimise);
  if (!flags.maximise.empty()) require_direction("--maximise", flags.maximise);
  query.maximise = !flags.maximise.empty();
  query.where = flags.where;
  query.allowed_failures = flags.allowed_failures;
  return query;
}

// What is said of a study alone has no use without one.
void refuse_flags_of_studies(const SelectFlags& flags) {
  const bool asks = !flags.requirements.empty() || !flags.where.empty() ||
                    !flags.minimise.empty() || !flags.maximise.empty() || !flags.out.empty() ||
                    flags.allowed_failures > 0.0;
  if (!asks) return;
  throw InputError(flags.results,
                   "is no study: of a log or a survey, select takes --quiet alone; 'fathom "
                   "compare' runs a study");
}

void select(const SelectFlags& flags, Context& context) {
  if (const auto advice = workflow::advice_for(flags.results)) {
    refuse_flags_of_studies(flags);
    context.status = kDone;
    if (!flags.quiet) print("%s\n", advice->c_str());
    return;
  }
  const workflow::SelectOutcome found = workflow::select(
      {flags.results, query_of(flags), flags.out}, context.estimators().registry());
  context.status = found.selection.chosen ? kDone : kFailed;
  if (flags.quiet) return;
  print("%s", found.text.c_str());
  if (found.selection.chosen) {
    print("\nwrote %s\nrun it with: fathom run %s\n", found.config.c_str(),
          shell_word(found.config.string()).c_str());
    print_named_code("which 'fathom run' executes", found.named);
  }
}

}  // namespace

void add_select(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SelectFlags>();
  Command command(
      program, "select", "Name the back end that meets requirements, or that suits a log",
      "Example: fathom select runs/study --require 'mean_position_error_m<=0.1'\n"
      "         --require 'update_ms.p95<=20' --minimise total_ms\n"
      "         fathom select intel.g2o\n"
      "Exit status: 0 chosen, and selected.yaml for 'fathom run' written; 1 none meets; 2 bad "
      "input.");
  command.argument(
      "results", flags->results,
      "Folder of a study, or its results.sqlite; or a pose graph, a run's folder, a survey");
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
