#include "apps/study_files.hpp"

#include <cstdio>
#include <string>

#include "fathom/core/files.hpp"
#include "fathom/report/study_report.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

void require_separate(const std::filesystem::path& out, const Study& study,
                      const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::string> names{kResultsFile,         "report.html",      "runs.csv",
                                 "summary.csv",        "tables.tex",       "figures",
                                 "trajectories.png",   "metrics.json",     "table.txt",
                                 "dead_reckoning.tum", "measurements.g2o", "ground_truth.tum"};
  for (const EstimatorConfiguration& one : study.cells.front().estimators) {
    names.push_back(one.name);
  }
  for (const std::string& name : names) refuse_replacing(out / name, inputs);
}

void write_study_files(const ResultStore& store, const std::filesystem::path& out, bool quiet) {
  write_study_report(store, out);
  const std::string table = study_table(store);
  write_file(out / "table.txt", table);
  if (quiet) return;
  // A sweep of many cells would scroll away.
  constexpr std::size_t kCellsInFull = 3;
  const bool brief = store.study().cell_count() > kCellsInFull;
  std::printf("%s\nwrote %s\n",
              brief ? study_table(store, StudyTable::brief).c_str() : table.c_str(),
              (out / "report.html").c_str());
  const auto picture = out / "trajectories.png";
  if (std::filesystem::exists(picture)) std::printf("      %s\n", picture.c_str());
  if (brief) {
    std::printf("      %s: all metrics, and the estimators' differences\n",
                (out / "table.txt").c_str());
  }
}

}  // namespace fathom
