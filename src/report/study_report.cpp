#include "fathom/report/study_report.hpp"

#include "fathom/core/files.hpp"
#include "latex_tables.hpp"
#include "report_page.hpp"
#include "study_csv.hpp"

namespace fathom {

void write_study_report(const ResultStore& store, const std::filesystem::path& folder) {
  const StudyResults results = study_results(store);
  StagedFolder out(folder);
  write_file(out.path() / "runs.csv", runs_csv(results));
  write_file(out.path() / "summary.csv", summary_csv(results));
  write_file(out.path() / "tables.tex", latex_tables(results));
  write_file(out.path() / "report.html", report_page(store, results));
  out.commit();
}

}  // namespace fathom
