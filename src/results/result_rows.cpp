#include "result_rows.hpp"

#include <SQLiteCpp/VariadicBind.h>
#include <cmath>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "fathom/core/hash.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "result_schema.hpp"

namespace fathom {
namespace {

std::string_view bytes_of(const std::vector<double>& values) {
  // An address that is null would be stored as no value at all.
  if (values.empty()) return "";
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
}

std::vector<double> values_of(const SQLite::Column& blob) {
  std::vector<double> values(static_cast<std::size_t>(blob.getBytes()) / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), blob.getBlob(), values.size() * sizeof(double));
  return values;
}

// Over all that is stored of a run but its series, which are added in the order of their names.
Hash hash_of(const RunRecord& run) {
  Hash hash;
  hash.add(run.key.cell).add(run.key.survey).add(run.key.trial).add(run.key.estimator);
  hash.add(run.outcome).add(run.fault).add(run.log_hash).add(run.jobs);
  hash.add(run.metrics.size());
  for (const auto& [name, value] : run.metrics) hash.add(name).add(value);
  return hash;
}

void add_series(Hash& hash, std::string_view name, std::string_view bytes) {
  hash.add(name).add(bytes);
}

std::int64_t checksum_of(const Hash& hash) {
  return static_cast<std::int64_t>(hash.value());
}

struct StoredRun {
  RunRecord record;
  std::int64_t checksum = 0;
  Hash hash;  ///< of what was read
};

/// Runs as they stand in the file, by place, not yet compared with their checksums.
class RunReader {
 public:
  explicit RunReader(SQLite::Database& database) : database_(database) {
    read_keys();
    read_values();
    for (StoredRun& run : runs_) run.hash = hash_of(run.record);
    read_series_bytes();
  }

  std::vector<StoredRun>& runs() { return runs_; }

 private:
  void read_keys() {
    SQLite::Statement rows(
        database_,
        "SELECT run, cell, survey, trial, name, outcome, log_hash, jobs, checksum, fault "
        "FROM run LEFT JOIN estimator USING (estimator) "
        "ORDER BY cell, survey, trial, estimator");
    while (rows.executeStep()) {
      StoredRun run;
      run.record.key = {static_cast<std::size_t>(rows.getColumn(1).getInt64()),
                        static_cast<std::size_t>(rows.getColumn(2).getInt64()),
                        static_cast<std::size_t>(rows.getColumn(3).getInt64()),
                        rows.getColumn(4).getString()};
      run.record.outcome = rows.getColumn(5).getString();
      run.record.log_hash = rows.getColumn(6).getString();
      run.record.jobs = rows.getColumn(7).getInt();
      run.checksum = rows.getColumn(8).getInt64();
      run.record.fault = rows.getColumn(9).getString();
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
  std::vector<StoredRun> runs_;
  std::unordered_map<std::int64_t, std::size_t> place_of_run_;
};

std::string text_of(const RunKey& key, const StudyDescription& study) {
  const bool is_known = key.cell < study.cell_count();
  return "run '" + key.estimator + "', " + text_of(key.trial_key()) + ", cell '" +
         (is_known ? study.label_of(key.cell) : std::to_string(key.cell)) + "'";
}

}  // namespace

std::vector<RunRecord> read_runs(SQLite::Database& database, const StudyDescription& study) {
  RunReader reader(database);
  std::vector<RunRecord> records;
  records.reserve(reader.runs().size());
  for (StoredRun& run : reader.runs()) {
    if (checksum_of(run.hash) != run.checksum || run.record.key.cell >= study.cell_count()) {
      throw DamagedStore("is damaged: " + text_of(run.record.key, study) +
                         " is not what was stored (its checksum differs)" + kRemedy);
    }
    records.push_back(std::move(run.record));
  }
  return records;
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

bool insert_run(SQLite::Database& database, const RunRecord& record, std::int64_t session) {
  RunRecord run = record;
  std::erase_if(run.metrics, [](const auto& metric) { return !std::isfinite(metric.second); });
  Hash hash = hash_of(run);
  for (const auto& [name, values] : run.series) add_series(hash, name, bytes_of(values));
  SQLite::Statement insert(
      database,
      "INSERT OR IGNORE INTO run (cell, survey, trial, estimator, outcome, fault, log_hash, jobs, "
      "session, checksum) SELECT ?, ?, ?, estimator, ?, ?, ?, ?, ?, ? FROM estimator "
      "WHERE name = ?");
  SQLite::bind(insert, static_cast<std::int64_t>(run.key.cell),
               static_cast<std::int64_t>(run.key.survey), static_cast<std::int64_t>(run.key.trial),
               run.outcome, run.fault, run.log_hash, run.jobs, session, checksum_of(hash),
               run.key.estimator);
  if (insert.exec() == 0) return false;
  const std::int64_t id = database.getLastInsertRowid();
  SQLite::Statement metric(database, "INSERT OR IGNORE INTO metric (name, is_cost) VALUES (?, ?)");
  SQLite::Statement value(database,
                          "INSERT INTO value SELECT ?, metric, ? FROM metric WHERE name = ?");
  for (const auto& [name, number] : run.metrics) {
    SQLite::bind(metric, name, is_cost_metric(name) ? 1 : 0);
    metric.exec();
    metric.reset();
    SQLite::bind(value, id, number, name);
    value.exec();
    value.reset();
  }
  SQLite::Statement series(database, "INSERT INTO series VALUES (?, ?, ?)");
  for (const auto& [name, values] : run.series) {
    const std::string_view bytes = bytes_of(values);
    series.bind(1, id);
    series.bind(2, name);
    series.bind(3, bytes.data(), static_cast<int>(bytes.size()));
    series.exec();
    series.reset();
  }
  return true;
}

}  // namespace fathom
