#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// Throws InputError on the folder of a study, into which a run's files would mix.
void require_no_study(const std::filesystem::path& out);

/// Throws InputError on the folder of a run, with which a study's files would mix.
void require_no_run(const std::filesystem::path& out);

/// The same, and where a file of a study's folder would replace one that it reads: said before
/// anything is computed.
void require_separate(const std::filesystem::path& out, const Study& study,
                      const std::vector<std::filesystem::path>& inputs);

/// Whether each estimator has a run that can be used: one that no trial of any cell could use has
/// failed.
bool all_usable(const ResultStore& store);

/// Writes the page, tables and figures of a study with runs, and table.txt. Returns the table, of
/// many cells in brief: all of it would scroll away.
std::string write_study_files(const ResultStore& store, const std::filesystem::path& out,
                              Observer& observer);

}  // namespace fathom::workflow
