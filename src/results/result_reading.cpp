#include <SQLiteCpp/VariadicBind.h>
#include <cstring>
#include <fmt/format.h>
#include <string_view>
#include <unordered_map>

#include "result_rows.hpp"
#include "result_schema.hpp"
#include "run_checksum.hpp"

namespace fathom {
namespace {

std::vector<double> values_of(const SQLite::Column& blob) {
  std::vector<double> values(static_cast<std::size_t>(blob.getBytes()) / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), blob.getBlob(), values.size() * sizeof(double));
  return values;
}

struct StoredRun {
  RunRecord record;
  std::int64_t checksum = 0;
  Hash hash;  ///< of what was read
};

// Columns of a run, joined with its estimator.
constexpr const char* kColumns =
    "run, cell, survey, trial, name, outcome, log_hash, jobs, checksum, fault, session";

// Without its values and series.
StoredRun stored_run(SQLite::Statement& row) {
  StoredRun run;
  run.record.key = {static_cast<std::size_t>(row.getColumn(1).getInt64()),
                    static_cast<std::size_t>(row.getColumn(2).getInt64()),
                    static_cast<std::size_t>(row.getColumn(3).getInt64()),
                    row.getColumn(4).getString()};
  run.record.outcome = row.getColumn(5).getString();
  run.record.log_hash = row.getColumn(6).getString();
  run.record.jobs = row.getColumn(7).getInt();
  run.checksum = row.getColumn(8).getInt64();
  run.record.fault = row.getColumn(9).getString();
  return run;
}

struct StoredSession {
  std::size_t place = 0;
  std::string machine;
};

// By number. What is no manifest names no machine.
using Sessions = std::unordered_map<std::int64_t, StoredSession>;

Sessions read_sessions(SQLite::Database& database) {
  Sessions sessions;
  SQLite::Statement rows(database,
                         "SELECT session, CASE WHEN json_valid(manifest) THEN "
                         "json_extract(manifest, '$.machine.cpu') END FROM session "
                         "ORDER BY session");
  while (rows.executeStep()) {
    const std::size_t place = sessions.size();
    sessions[rows.getColumn(0).getInt64()] = {place, rows.getColumn(1).getString()};
  }
  return sessions;
}

void set_session(RunRecord& run, const Sessions& sessions, std::int64_t number) {
  const auto found = sessions.find(number);
  if (found == sessions.end()) {
    throw DamagedStore("is damaged: it has a run of a session that it has not" +
                       std::string(kRemedy));
  }
  run.session = found->second.place;
  run.machine = found->second.machine;
}

/// Runs as they stand in the file, by place, not yet compared with their checksums.
class RunReader {
 public:
  explicit RunReader(SQLite::Database& database)
      : database_(database), sessions_(read_sessions(database)) {
    read_keys();
    read_values();
    for (StoredRun& run : runs_) run.hash = hash_of(run.record);
    read_series_bytes();
  }

  std::vector<StoredRun>& runs() { return runs_; }

 private:
  void read_keys() {
    SQLite::Statement rows(database_, std::string("SELECT ") + kColumns +
                                          " FROM run LEFT JOIN estimator USING (estimator) "
                                          "ORDER BY cell, survey, trial, estimator");
    while (rows.executeStep()) {
      StoredRun run = stored_run(rows);
      set_session(run.record, sessions_, rows.getColumn(10).getInt64());
      place_of_run_[rows.getColumn(0).getInt64()] = runs_.size();
      runs_.push_back(std::move(run));
    }
  }

  void read_values() {
    SQLite::Statement rows(database_,
                           "SELECT run, name, value FROM value LEFT JOIN metric USING (metric)");
    while (rows.executeStep()) {
      run_of(rows.getColumn(0)).record.metrics[rows.getColumn(1).getString()] =
          rows.getColumn(2).getDouble();
    }
  }

  void read_series_bytes() {
    SQLite::Statement rows(database_, "SELECT run, name, data FROM series ORDER BY run, name");
    while (rows.executeStep()) {
      const SQLite::Column blob = rows.getColumn(2);
      const std::string_view bytes(static_cast<const char*>(blob.getBlob()),
                                   static_cast<std::size_t>(blob.getBytes()));
      add_series(run_of(rows.getColumn(0)).hash, rows.getColumn(1).getString(), bytes);
    }
  }

  StoredRun& run_of(const SQLite::Column& run) {
    const auto found = place_of_run_.find(run.getInt64());
    if (found == place_of_run_.end()) {
      throw DamagedStore("is damaged: it has numbers of a run that it has not" +
                         std::string(kRemedy));
    }
    return runs_[found->second];
  }

  SQLite::Database& database_;
  Sessions sessions_;
  std::vector<StoredRun> runs_;
  std::unordered_map<std::int64_t, std::size_t> place_of_run_;
};

std::string text_of(const RunKey& key, const StudyDescription& study) {
  const bool is_known = key.cell < study.cell_count();
  return fmt::format("run '{}', {}, cell '{}'", key.estimator, text_of(key.trial_key()),
                     is_known ? study.label_of(key.cell) : std::to_string(key.cell));
}

// Throws DamagedStore where a run is not what was stored.
void require_intact(const StoredRun& run, const Hash& hash, const StudyDescription& study) {
  if (checksum_of(hash) == run.checksum && run.record.key.cell < study.cell_count()) return;
  throw DamagedStore(fmt::format("is damaged: {} is not what was stored (its checksum differs){}",
                                 text_of(run.record.key, study), kRemedy));
}

}  // namespace

std::vector<RunRecord> read_runs(SQLite::Database& database, const StudyDescription& study) {
  RunReader reader(database);
  std::vector<RunRecord> records;
  records.reserve(reader.runs().size());
  for (StoredRun& run : reader.runs()) {
    require_intact(run, run.hash, study);
    records.push_back(std::move(run.record));
  }
  return records;
}

std::optional<RunRecord> read_run(SQLite::Database& database, const StudyDescription& study,
                                  const RunKey& key) {
  SQLite::Statement row(database, std::string("SELECT ") + kColumns +
                                      " FROM run JOIN estimator USING (estimator) "
                                      "WHERE cell = ? AND survey = ? AND trial = ? AND name = ?");
  SQLite::bind(row, static_cast<std::int64_t>(key.cell), static_cast<std::int64_t>(key.survey),
               static_cast<std::int64_t>(key.trial), key.estimator);
  if (!row.executeStep()) return std::nullopt;
  StoredRun run = stored_run(row);
  const std::int64_t id = row.getColumn(0).getInt64();
  SQLite::Statement values(database,
                           "SELECT name, value FROM value JOIN metric USING (metric) "
                           "WHERE run = ?");
  values.bind(1, id);
  while (values.executeStep()) {
    run.record.metrics[values.getColumn(0).getString()] = values.getColumn(1).getDouble();
  }
  Hash hash = hash_of(run.record);
  SQLite::Statement series(database, "SELECT name, data FROM series WHERE run = ? ORDER BY name");
  series.bind(1, id);
  while (series.executeStep()) {
    std::vector<double>& own = run.record.series[series.getColumn(0).getString()];
    own = values_of(series.getColumn(1));
    add_series(hash, series.getColumn(0).getString(), bytes_of(own));
  }
  require_intact(run, hash, study);
  set_session(run.record, read_sessions(database), row.getColumn(10).getInt64());
  return std::move(run.record);
}

std::optional<std::vector<double>> read_series(SQLite::Database& database, const RunKey& key,
                                               const std::string& name) {
  SQLite::Statement select(database,
                           "SELECT data FROM series JOIN run USING (run) "
                           "JOIN estimator USING (estimator) "
                           "WHERE cell = ? AND survey = ? AND trial = ? AND estimator.name = ? "
                           "AND series.name = ?");
  SQLite::bind(select, static_cast<std::int64_t>(key.cell), static_cast<std::int64_t>(key.survey),
               static_cast<std::int64_t>(key.trial), key.estimator, name);
  if (!select.executeStep()) return std::nullopt;
  return values_of(select.getColumn(0));
}

}  // namespace fathom
