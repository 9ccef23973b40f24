// fathom select: the back end that meets a user's requirements, from the results of a study.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "fathom/core/files.hpp"
#include "fathom/report/selection_text.hpp"
#include "fathom/results/selected_config.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {
namespace {

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

std::filesystem::path folder_of(const SelectFlags& flags) {
  if (!flags.out.empty()) return flags.out;
  std::filesystem::path results = flags.results;
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

// The registry has to know what was chosen.
void load_plugins_for(const StudyEstimator& chosen, const StudyDescription& study,
                      workflow::KnownEstimators& estimators) {
  const auto& known = estimators.registry().entries();
  if (std::ranges::find(known, chosen.type, &EstimatorEntry::name) != known.end()) return;
  Settings settings;
  for (const auto& [key, value] : study.configuration) {
    if (key == "plugins") settings.put(parse_override(key + "=" + value));
  }
  estimators.load(settings, {});
}

void select(const SelectFlags& flags, Context& context) {
  const SelectionQuery query = query_of(flags);
  const ResultStore store = ResultStore::open(flags.results);
  const Selection selection = select_estimator(store, query);
  if (selection.chosen)
    load_plugins_for(store.study().estimators[*selection.chosen], store.study(),
                     context.estimators());
  std::filesystem::path config;
  if (selection.chosen) {
    config = write_config(flags, selected_configuration(store.study(), selection, query,
                                                        context.estimators().registry()));
  }
  context.status = selection.chosen ? kDone : kFailed;
  if (flags.quiet) return;
  std::printf("%s", selection_text(selection, query, store.study()).c_str());
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
