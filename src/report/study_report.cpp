#include "fathom/report/study_report.hpp"

#include "fathom/core/files.hpp"
#include "figure_file.hpp"
#include "latex_tables.hpp"
#include "report_page.hpp"
#include "study_csv.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

void write_figures(const FigureInput& input, const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  for (const StudyFigure& figure : study_figures(input)) {
    for (const auto& [format, ending] :
         {std::pair(FigureFormat::svg, ".svg"), std::pair(FigureFormat::pdf, ".pdf")}) {
      write_file(folder / (figure.name + ending),
                 render_figure(format, {kFigureWidth, figure.height}, figure.draw));
    }
  }
}

}  // namespace

void write_study_report(const ResultStore& store, const std::filesystem::path& folder) {
  const StudyResults results = study_results(store);
  // Before the work: a folder that cannot be written is said at once.
  StagedFolder out(folder);
  const auto series = study_series(store, results);
  write_file(out.path() / "runs.csv", runs_csv(results));
  write_file(out.path() / "summary.csv",
             summary_csv(results, results_of_other_machines(store, results)));
  write_file(out.path() / "tables.tex", latex_tables(results));
  write_file(out.path() / "report.html", report_page(store, results, series));
  write_figures({store, results, series}, out.path() / "figures");
  out.commit();
}

}  // namespace fathom
