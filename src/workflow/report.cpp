#include "fathom/workflow/report.hpp"

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/report/study_report.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

// The folder of a study may be an archive.
void check_writable(const fs::path& folder) {
  try {
    const StagedFolder probe(folder);
  } catch (const InputError&) {
    throw InputError(folder.string(), "cannot be written; --out DIR takes another folder");
  }
}

}  // namespace

ReportOutcome report(const fs::path& study, const fs::path& out) {
  const ResultStore store = ResultStore::open(study);
  fs::path own = fs::is_directory(study) ? study : study.parent_path();
  if (own.empty()) own = ".";
  const fs::path folder = out.empty() ? own : out;
  refuse_replacing(folder / "figures", {study});
  if (out.empty()) check_writable(folder);
  write_study_report(store, folder, own);
  return {folder / "report.html", study_remarks(store)};
}

}  // namespace fathom::workflow
