#include "result_rows.hpp"

#include <SQLiteCpp/VariadicBind.h>
#include <cmath>
#include <string_view>

#include "fathom/evaluation/metrics.hpp"
#include "run_checksum.hpp"

namespace fathom {

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
