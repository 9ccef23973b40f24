#pragma once

#include <filesystem>
#include <string>

namespace fathom::workflow {

struct ReportOutcome {
  std::filesystem::path page;
  std::string findings;  ///< in words, a line each (study_remarks)
};

/// Writes the page, tables and figures of a study that was run, from its store alone: into its own
/// folder, or into `out`. `study` is the folder or its results.sqlite. Throws InputError.
ReportOutcome report(const std::filesystem::path& study, const std::filesystem::path& out);

}  // namespace fathom::workflow
