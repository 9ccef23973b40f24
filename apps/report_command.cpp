// fathom report: the page, tables and figures of a study, from its store alone.

#include <cstdio>
#include <memory>

#include "apps/command.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/report/study_report.hpp"

namespace fathom {
namespace {

struct ReportFlags {
  std::string study;
  std::string out;
};

// The folder of a study may be an archive.
void check_writable(const std::filesystem::path& folder) {
  try {
    const StagedFolder probe(folder);
  } catch (const InputError&) {
    throw InputError(folder.string(), "cannot be written; --out DIR takes another folder");
  }
}

void report(const ReportFlags& flags) {
  const ResultStore store = ResultStore::open(flags.study);
  std::filesystem::path study = flags.study;
  if (!std::filesystem::is_directory(study)) study = study.parent_path();
  if (study.empty()) study = ".";
  const std::filesystem::path folder = flags.out.empty() ? study : std::filesystem::path(flags.out);
  refuse_replacing(folder / "figures", {flags.study});
  if (flags.out.empty()) check_writable(folder);
  write_study_report(store, folder, study);
  std::printf("%swrote %s\n", study_remarks(store).c_str(),
              (folder / "report.html").string().c_str());
}

}  // namespace

void add_report(CLI::App& program, Context& context) {
  auto flags = std::make_shared<ReportFlags>();
  Command command(
      program, "report", "Write the page, tables and figures of a study that was run",
      "Example: fathom report runs/noise --out report\n"
      "Writes report.html (one file, opens without a network), runs.csv, summary.csv, tables.tex\n"
      "and figures/ as SVG and PDF, from the study's results.sqlite. The page also shows the "
      "mosaics\n"
      "that compare wrote beside it.");
  command.argument("study", flags->study, "Folder of a study, or its results.sqlite");
  command.text("--out", flags->out, "DIR", "Folder to write into; the study's own if not given");
  command.on_run([flags, &context] {
    context.status = kDone;
    report(*flags);
  });
}

}  // namespace fathom
