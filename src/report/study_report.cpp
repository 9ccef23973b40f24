#include "fathom/report/study_report.hpp"

#include "fathom/core/files.hpp"
#include "figure_file.hpp"
#include "latex_tables.hpp"
#include "page_mosaics.hpp"
#include "ranking.hpp"
#include "report_page.hpp"
#include "study_csv.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

void write_figures(const ChartInput& input, const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  for (const StudyFigure& figure : study_figures(input)) {
    for (const auto& [format, ending] :
         {std::pair(FigureFormat::svg, ".svg"), std::pair(FigureFormat::pdf, ".pdf")}) {
      write_file(folder / (figure.name + ending),
                 render_figure(format, {kFigureWidth, figure.height}, figure.draw));
    }
  }
}

// Of the first cell, whose example `compare` writes.
nlohmann::ordered_json example_mosaics(const StudyResults& results,
                                       const std::filesystem::path& study_folder) {
  std::vector<std::string> names;
  for (const auto& [name, type] : results.study.estimators) names.push_back(name);
  const auto metric = ranking_metric(results).name;
  const auto ranked = metric ? ranking(results.cells.front(), *metric) : std::nullopt;
  return page_mosaics(study_folder, names,
                      ranked ? std::optional(ranked->best().name) : std::nullopt);
}

}  // namespace

void write_study_report(const ResultStore& store, const std::filesystem::path& folder) {
  write_study_report(store, folder, folder);
}

void write_study_report(const ResultStore& store, const std::filesystem::path& folder,
                        const std::filesystem::path& study_folder) {
  const StudyResults results = study_results(store);
  // Before the work: a folder that cannot be written is said at once.
  StagedFolder out(folder);
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  write_file(out.path() / "runs.csv", runs_csv(results));
  write_file(out.path() / "summary.csv",
             summary_csv(results, results_of_other_machines(store, results)));
  write_file(out.path() / "tables.tex", latex_tables(results));
  const std::filesystem::path whole = std::filesystem::absolute(study_folder).lexically_normal();
  const std::string name = (whole.has_filename() ? whole : whole.parent_path()).filename().string();
  write_file(out.path() / "report.html", report_page(store, {results, series, examples},
                                                     example_mosaics(results, study_folder), name));
  write_figures({results, series, examples}, out.path() / "figures");
  out.commit();
}

}  // namespace fathom
