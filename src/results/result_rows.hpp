#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// All runs without their series, in the order of cell, survey, trial and estimator. Throws
/// DamagedStore where any run, its series included, is not what was stored.
std::vector<RunRecord> read_runs(SQLite::Database& database, const StudyDescription& study);

/// A run with its series; nothing where there is none. Throws DamagedStore where it is not what was
/// stored.
std::optional<RunRecord> read_run(SQLite::Database& database, const StudyDescription& study,
                                  const RunKey& key);

/// A series of one run; nothing where the run has none of that name.
std::optional<std::vector<double>> read_series(SQLite::Database& database, const RunKey& key,
                                               const std::string& name);

/// Stores a run within a transaction; false, and nothing done, where it is there already.
bool insert_run(SQLite::Database& database, const RunRecord& run, std::int64_t session);

}  // namespace fathom
