// fathom report: the page, tables and figures of a study, from its store alone.

#include <memory>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "fathom/workflow/report.hpp"

namespace fathom {
namespace {

struct ReportFlags {
  std::string study;
  std::string out;
};

void report(const ReportFlags& flags) {
  const workflow::ReportOutcome done = workflow::report(flags.study, flags.out);
  print("%swrote %s\n", done.findings.c_str(), done.page.c_str());
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
  command.quiet();
  command.on_run([flags, &context] {
    context.status = kDone;
    report(*flags);
  });
}

}  // namespace fathom
