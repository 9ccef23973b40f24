#pragma once

#include <filesystem>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// Writes the page, tables and figures of a study with runs, and table.txt, and prints the table.
void write_study_files(const ResultStore& store, const std::filesystem::path& out, bool quiet);

}  // namespace fathom
