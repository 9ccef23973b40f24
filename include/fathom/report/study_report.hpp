#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// The table at the end of a study, for a terminal of 160 columns: per cell a block with a row an
/// estimator, dead reckoning first. Metrics are means over the trials that were done, with their
/// 95 % bootstrap interval; what was not done stands in the row. Below come the differences to the
/// first estimator over the trials that both did, with the p-value of Wilcoxon's signed-rank test,
/// also adjusted after Holm over the tests of the block.
/// Where the consistency of an estimator means something, a line says what (docs/report.md).
/// The verdict ends it: which estimators can be told apart, what they cost, what failed, and what
/// makes that doubtful.
/// In brief: without these lines and the differences, and with the first metrics alone, as many as
/// fit a line.
enum class StudyTable { full, brief };
std::string study_table(const ResultStore& store, StudyTable extent = StudyTable::full);

/// The means of an estimator, or of dead reckoning, on one cell, as the table has them: over the
/// runs that were done, of several surveys over the surveys' means, of costs over the runs of one
/// kind of processor. Of all metrics.
struct StudyMeans {
  std::size_t cell = 0;
  std::string estimator;
  std::size_t runs = 0;
  std::size_t done = 0;
  std::map<std::string, double> means;
};
std::vector<StudyMeans> study_means(const ResultStore& store);

/// By cell and estimator its mean of a metric over that of the cell's best, as the regime map has
/// them (docs/report.md): of the estimators that are ranked, over the same trials.
using RelativeMeans = std::map<std::size_t, std::map<std::string, double>>;
RelativeMeans means_over_best(const ResultStore& store, const std::string& metric);

/// Why a study's estimators are not ranked by a metric, without a full stop; empty where they may
/// be (docs/report.md).
std::string not_ranked_text(const ResultStore& store, const std::string& metric);

/// What the consistency of the estimators means, a line each under its cell where it is not as
/// expected; then the verdict.
std::string study_remarks(const ResultStore& store);

/// Renders a study from its store (docs/report.md): report.html, runs.csv, summary.csv, tables.tex
/// and figures/ with every figure as SVG and PDF. The page also shows the mosaics of the study's
/// example, where they lie in `study_folder` as `compare` writes them. The folder is made if need
/// be; its files of these names are replaced, all or none.
/// Throws InputError on a store without runs and where the folder cannot be written.
void write_study_report(const ResultStore& store, const std::filesystem::path& folder,
                        const std::filesystem::path& study_folder);
/// Of a study whose folder this is.
void write_study_report(const ResultStore& store, const std::filesystem::path& folder);

}  // namespace fathom
