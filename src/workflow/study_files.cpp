#include "study_files.hpp"

#include <set>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/report/study_report.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/run_index.hpp"

namespace fathom::workflow {

void require_no_study(const std::filesystem::path& out) {
  if (!std::filesystem::exists(out / kResultsFile)) return;
  throw InputError(out.string(), "holds a study; a run needs a folder of its own (--out)");
}

void require_no_run(const std::filesystem::path& out) {
  if (!std::filesystem::exists(out / "run.json")) return;
  throw InputError(out.string(), "holds a run; a study needs a folder of its own (--out)");
}

void require_separate(const std::filesystem::path& out, const Study& study,
                      const std::vector<std::filesystem::path>& inputs) {
  require_no_run(out);
  std::vector<std::string> names{kResultsFile,         "report.html",     "runs.csv",
                                 "summary.csv",        "tables.tex",      "figures",
                                 "trajectories.png",   "metrics.json",    "table.txt",
                                 "dead_reckoning.tum", "measurements.g2o"};
  names.insert(names.end(), optional_run_files().begin(), optional_run_files().end());
  for (const EstimatorConfiguration& one : study.cells.front().estimators) {
    names.push_back(one.name);
  }
  for (const std::string& name : names) refuse_replacing(out / name, inputs);
}

bool all_usable(const ResultStore& store) {
  std::set<std::string> usable;
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator != kDeadReckoning && !is_failed(run)) usable.insert(run.key.estimator);
  }
  return usable.size() == store.study().estimators.size();
}

std::string write_study_files(const ResultStore& store, const std::filesystem::path& out,
                              Observer& observer) {
  write_study_report(store, out);
  const std::string table = study_table(store);
  write_file(out / "table.txt", table);
  observer.wrote((out / "report.html").string());
  const auto picture = out / "trajectories.png";
  if (std::filesystem::exists(picture)) observer.wrote(picture.string());
  constexpr std::size_t kCellsInFull = 3;
  if (store.study().cell_count() <= kCellsInFull) return table;
  observer.wrote((out / "table.txt").string() + ": all metrics, and the estimators' differences");
  return study_table(store, StudyTable::brief);
}

}  // namespace fathom::workflow
