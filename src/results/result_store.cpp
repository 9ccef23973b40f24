#include "fathom/results/result_store.hpp"

#include <cmath>
#include <cstring>
#include <mutex>
#include <sqlite3.h>
#include <type_traits>

#include "fathom/core/file_lock.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "result_schema.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "results.sqlite";
constexpr int kBusyTimeoutMs = 10'000;

std::string blob_of(const std::vector<double>& values) {
  std::string bytes(values.size() * sizeof(double), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

std::vector<double> values_of(const SQLite::Column& blob) {
  std::vector<double> values(static_cast<std::size_t>(blob.getBytes()) / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), blob.getBlob(), values.size() * sizeof(double));
  return values;
}

std::int64_t number(std::size_t value) {
  return static_cast<std::int64_t>(value);
}

}  // namespace

class ResultStore::Database {
 public:
  Database(const fs::path& file, int flags) : file_(file) {
    guard([&] { sqlite_.emplace(file.string(), flags, kBusyTimeoutMs); });
  }

  /// Runs an action on the file; what SQLite throws becomes bad input that names the file.
  template <class Action>
  std::invoke_result_t<Action> guard(Action action) const {
    try {
      return action();
    } catch (const SQLite::Exception& error) {
      throw InputError(file_.string(), what_of(error));
    }
  }

  fs::path file_;
  mutable std::optional<SQLite::Database> sqlite_;
  std::unique_ptr<FileLock> lock_;
  StudyDescription study_;
  std::int64_t session_ = 0;
  std::mutex mutex_;

 private:
  static std::string what_of(const SQLite::Exception& error) {
    switch (error.getErrorCode()) {
      case SQLITE_FULL:
        return "the disk is full; nothing of the unfinished run was stored. Make room and run the "
               "same command again";
      case SQLITE_NOTADB:
      case SQLITE_CORRUPT:
        return std::string("is no result store, or a damaged one: ") + error.what();
      case SQLITE_READONLY:
      case SQLITE_CANTOPEN:
      case SQLITE_IOERR:
        return std::string("cannot be read or written: ") + error.what();
      default:
        return error.what();
    }
  }
};

namespace {

// What a file says of itself: nothing yet, a store of ours, or something else.
enum class Kind { empty, store };

Kind kind_of(SQLite::Database& sqlite, const fs::path& file) {
  const int id = sqlite.execAndGet("PRAGMA application_id").getInt();
  const int version = sqlite.execAndGet("PRAGMA user_version").getInt();
  const int tables = sqlite.execAndGet("SELECT count(*) FROM sqlite_master").getInt();
  if (tables == 0 && id == 0) return Kind::empty;
  if (id != kResultApplicationId) {
    throw InputError(file.string(), "is a database, but no result store of Fathom");
  }
  if (version != kResultSchemaVersion) {
    throw InputError(file.string(),
                     "has schema version " + std::to_string(version) + ", this program has " +
                         std::to_string(kResultSchemaVersion) + "; use the program that wrote it");
  }
  return Kind::store;
}

}  // namespace

ResultStore::ResultStore(std::unique_ptr<Database> database) : database_(std::move(database)) {}
ResultStore::~ResultStore() = default;
ResultStore::ResultStore(ResultStore&&) noexcept = default;

ResultStore ResultStore::open(const fs::path& path) {
  const fs::path file = fs::is_directory(path) ? path / kFileName : path;
  if (!fs::is_regular_file(file)) {
    throw InputError(file.string(), "there are no results; 'fathom compare' writes them");
  }
  auto database = std::make_unique<Database>(file, SQLite::OPEN_READONLY);
  database->guard([&] {
    if (kind_of(*database->sqlite_, file) == Kind::empty) {
      throw InputError(file.string(), "holds no study");
    }
    database->study_ = read_study(*database->sqlite_);
  });
  return ResultStore(std::move(database));
}

ResultStore ResultStore::write(const fs::path& folder, const StudyDescription& study,
                               const std::string& manifest) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
  const fs::path file = folder / kFileName;
  auto lock = std::make_unique<FileLock>(
      folder / "results.lock", folder.string() +
                                   ": another process is at work on this study; wait for it, or "
                                   "use another --out");
  auto database = std::make_unique<Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database->lock_ = std::move(lock);
  database->guard([&] {
    SQLite::Database& sqlite = *database->sqlite_;
    const Kind kind = kind_of(sqlite, file);
    if (kind == Kind::store) {
      const StudyDescription there = read_study(sqlite);
      const std::string differs = difference(there, study);
      if (!differs.empty()) {
        throw InputError(file.string(), "holds results of another configuration (" + differs +
                                            "); use another --out, or remove the folder");
      }
      const std::string changes = data_difference(there, study);
      if (!changes.empty()) {
        throw InputError(file.string(), "holds results of other data (" + changes +
                                            "); use another --out, or remove the folder");
      }
    }
    sqlite.exec("PRAGMA journal_mode = WAL");
    sqlite.exec("PRAGMA synchronous = NORMAL");
    SQLite::Transaction transaction(sqlite);
    if (kind == Kind::empty) create_schema(sqlite, study);
    write_labels(sqlite, study);
    SQLite::Statement trials(
        sqlite,
        "UPDATE study SET value = CAST(max(CAST(value AS INTEGER), ?) AS TEXT) "
        "WHERE key = 'trials'");
    trials.bind(1, number(study.trials));
    trials.exec();
    SQLite::Statement update(sqlite, "UPDATE study SET value = ? WHERE key = ?");
    for (const auto& [key, value] : {std::pair<std::string, std::string>{"title", study.title},
                                     {"metrics", words_text(study.metrics)}}) {
      SQLite::bind(update, value, key);
      update.exec();
      update.reset();
    }
    SQLite::Statement session(sqlite, "INSERT INTO session (manifest) VALUES (?)");
    session.bind(1, manifest);
    session.exec();
    database->session_ = sqlite.getLastInsertRowid();
    transaction.commit();
    database->study_ = read_study(sqlite);
  });
  return ResultStore(std::move(database));
}

const StudyDescription& ResultStore::study() const {
  return database_->study_;
}

std::vector<std::string> ResultStore::manifests() const {
  return database_->guard([&] {
    std::vector<std::string> all;
    SQLite::Statement select(*database_->sqlite_, "SELECT manifest FROM session ORDER BY session");
    while (select.executeStep()) all.push_back(select.getColumn(0).getString());
    return all;
  });
}

std::set<RunKey> ResultStore::keys() const {
  return database_->guard([&] {
    std::set<RunKey> all;
    SQLite::Statement select(*database_->sqlite_,
                             "SELECT cell, trial, name FROM run JOIN estimator USING (estimator)");
    while (select.executeStep()) {
      all.insert({static_cast<std::size_t>(select.getColumn(0).getInt64()),
                  static_cast<std::size_t>(select.getColumn(1).getInt64()),
                  select.getColumn(2).getString()});
    }
    return all;
  });
}

std::vector<RunRecord> ResultStore::runs() const {
  return database_->guard([&] {
    std::vector<RunRecord> all;
    std::map<std::int64_t, std::size_t> place_of_run;
    SQLite::Statement runs(*database_->sqlite_,
                           "SELECT run, cell, trial, name, outcome, log_hash, jobs, fault FROM run "
                           "JOIN estimator USING (estimator) ORDER BY cell, trial, estimator");
    while (runs.executeStep()) {
      RunRecord run;
      run.key = {static_cast<std::size_t>(runs.getColumn(1).getInt64()),
                 static_cast<std::size_t>(runs.getColumn(2).getInt64()),
                 runs.getColumn(3).getString()};
      run.outcome = runs.getColumn(4).getString();
      run.log_hash = runs.getColumn(5).getString();
      run.jobs = runs.getColumn(6).getInt();
      run.fault = runs.getColumn(7).getString();
      place_of_run[runs.getColumn(0).getInt64()] = all.size();
      all.push_back(std::move(run));
    }
    SQLite::Statement values(*database_->sqlite_,
                             "SELECT run, name, value FROM value JOIN metric USING (metric)");
    while (values.executeStep()) {
      all[place_of_run.at(values.getColumn(0).getInt64())]
          .metrics[values.getColumn(1).getString()] = values.getColumn(2).getDouble();
    }
    return all;
  });
}

std::optional<std::vector<double>> ResultStore::series(const RunKey& key,
                                                       const std::string& name) const {
  return database_->guard([&]() -> std::optional<std::vector<double>> {
    SQLite::Statement select(*database_->sqlite_,
                             "SELECT data FROM series JOIN run USING (run) "
                             "JOIN estimator USING (estimator) "
                             "WHERE cell = ? AND trial = ? AND estimator.name = ? "
                             "AND series.name = ?");
    SQLite::bind(select, number(key.cell), number(key.trial), key.estimator, name);
    if (!select.executeStep()) return std::nullopt;
    return values_of(select.getColumn(0));
  });
}

void ResultStore::add(const RunRecord& run) {
  const std::lock_guard hold(database_->mutex_);
  database_->guard([&] {
    SQLite::Database& sqlite = *database_->sqlite_;
    SQLite::Transaction transaction(sqlite, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement insert(sqlite,
                             "INSERT OR IGNORE INTO run (cell, trial, estimator, outcome, fault, "
                             "log_hash, jobs, session) "
                             "SELECT ?, ?, estimator, ?, ?, ?, ?, ? FROM estimator WHERE name = ?");
    SQLite::bind(insert, number(run.key.cell), number(run.key.trial), run.outcome, run.fault,
                 run.log_hash, run.jobs, database_->session_, run.key.estimator);
    if (insert.exec() == 0) return;
    const std::int64_t id = sqlite.getLastInsertRowid();
    SQLite::Statement metric(sqlite, "INSERT OR IGNORE INTO metric (name, is_cost) VALUES (?, ?)");
    SQLite::Statement value(sqlite,
                            "INSERT INTO value SELECT ?, metric, ? FROM metric WHERE name = ?");
    for (const auto& [name, number] : run.metrics) {
      if (!std::isfinite(number)) continue;
      SQLite::bind(metric, name, is_cost_metric(name) ? 1 : 0);
      metric.exec();
      metric.reset();
      SQLite::bind(value, id, number, name);
      value.exec();
      value.reset();
    }
    SQLite::Statement series(sqlite, "INSERT INTO series VALUES (?, ?, ?)");
    for (const auto& [name, values] : run.series) {
      const std::string bytes = blob_of(values);
      series.bind(1, id);
      series.bind(2, name);
      series.bind(3, bytes.data(), static_cast<int>(bytes.size()));
      series.exec();
      series.reset();
    }
    transaction.commit();
  });
}

void ResultStore::finish() {
  const std::lock_guard hold(database_->mutex_);
  // Out of WAL: a reader of a read-only folder could not make the files that go with it.
  // Where somebody is reading just now it stays in WAL, which is no fault.
  database_->guard([&] { database_->sqlite_->tryExec("PRAGMA journal_mode = DELETE"); });
}

}  // namespace fathom
