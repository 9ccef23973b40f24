#include "fathom/results/result_store.hpp"

#include <SQLiteCpp/VariadicBind.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include "result_database.hpp"
#include "result_rows.hpp"
#include "result_schema.hpp"
#include "store_guard.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<FileLock> lock_of(const fs::path& folder) {
  return std::make_unique<FileLock>(folder / "results.lock",
                                    folder.string() +
                                        ": another process is at work on this study; wait for it, "
                                        "or use another --out");
}

}  // namespace

std::string text_of(const TrialKey& trial) {
  return fmt::format("trial {} of survey {}", trial.trial, trial.survey);
}

ResultStore::ResultStore(std::unique_ptr<Database> database) : database_(std::move(database)) {}
ResultStore::~ResultStore() = default;
ResultStore::ResultStore(ResultStore&&) noexcept = default;
ResultStore& ResultStore::operator=(ResultStore&&) noexcept = default;

bool is_run_folder(const fs::path& path) {
  std::error_code error;
  return fs::exists(path / "metrics.json", error) && !fs::exists(path / kResultsFile, error);
}

void refuse_run_folder(const fs::path& path) {
  if (!is_run_folder(path)) return;
  throw InputError(path.string(), "is the folder of a run; expected that of a study");
}

ResultStore ResultStore::open(const fs::path& path) {
  refuse_run_folder(path);
  const fs::path file = fs::is_directory(path) ? path / kResultsFile : path;
  if (!fs::is_regular_file(file)) {
    throw InputError(file.string(), "there are no results; 'fathom compare' writes them");
  }
  auto database = std::make_unique<Database>(file, SQLite::OPEN_READONLY);
  database->guard([&] {
    const SQLite::Transaction snapshot(*database->sqlite);
    if (!database->is_store()) throw InputError(file.string(), "holds no study");
    database->study = read_study(*database->sqlite);
    read_manifests(*database->sqlite);
    read_runs(*database->sqlite, database->study);
  });
  return ResultStore(std::move(database));
}

ResultStore ResultStore::write(const fs::path& folder, const StudyDescription& study,
                               const std::string& manifest) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
  const fs::path file = folder / kResultsFile;
  auto lock = lock_of(folder);
  auto database = std::make_unique<Database>(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database->lock = std::move(lock);
  database->guard([&] {
    SQLite::Database& sqlite = *database->sqlite;
    const bool is_store = database->is_store();
    if (is_store) {
      const StudyDescription there = read_study(sqlite);
      require_same(there, study, file);
      read_manifests(sqlite);
      read_runs(sqlite, there);
    }
    sqlite.exec("PRAGMA journal_mode = WAL");
    sqlite.exec("PRAGMA synchronous = NORMAL");
    SQLite::Transaction transaction(sqlite);
    if (!is_store) create_schema(sqlite, study);
    // What of a study may change from session to session.
    update_study(sqlite, study);
    database->session = insert_session(sqlite, manifest);
    transaction.commit();
    database->study = read_study(sqlite);
  });
  return ResultStore(std::move(database));
}

const StudyDescription& ResultStore::study() const {
  return database_->study;
}

const fs::path& ResultStore::file() const {
  return database_->file;
}

std::vector<std::string> ResultStore::manifests() const {
  return database_->guard([&] { return read_manifests(*database_->sqlite); });
}

std::vector<RunRecord> ResultStore::runs() const {
  const std::lock_guard hold(database_->mutex);
  return database_->guard([&] {
    // Of several statements: what another process stores between them is not half there.
    const SQLite::Transaction snapshot(*database_->sqlite);
    return read_runs(*database_->sqlite, database_->study);
  });
}

std::optional<std::vector<double>> ResultStore::series(const RunKey& key,
                                                       const std::string& name) const {
  return database_->guard([&] { return read_series(*database_->sqlite, key, name); });
}

std::optional<RunRecord> ResultStore::run(const RunKey& key) const {
  return database_->guard([&] { return read_run(*database_->sqlite, database_->study, key); });
}

void ResultStore::begin_session(const std::string& manifest) {
  const std::lock_guard hold(database_->mutex);
  database_->guard([&] { database_->session = insert_session(*database_->sqlite, manifest); });
}

void ResultStore::add(const RunRecord& run) {
  const std::lock_guard hold(database_->mutex);
  database_->guard([&] {
    SQLite::Transaction transaction(*database_->sqlite, SQLite::TransactionBehavior::IMMEDIATE);
    if (insert_run(*database_->sqlite, run, database_->session)) transaction.commit();
  });
}

void ResultStore::copy_to(const fs::path& file) const {
  const std::lock_guard hold(database_->mutex);
  database_->guard([&] {
    SQLite::Statement copy(*database_->sqlite, "VACUUM INTO ?");
    copy.bind(1, file.string());
    copy.exec();
  });
}

void ResultStore::finish() {
  const std::lock_guard hold(database_->mutex);
  // Out of WAL: a reader of a read-only folder could not make the files that go with it.
  // Where somebody is reading just now it stays in WAL, which is no fault.
  database_->guard([&] {
    SQLite::Database& sqlite = *database_->sqlite;
    const int code = sqlite.tryExec("PRAGMA journal_mode = DELETE");
    if (code == SQLITE_OK || code == SQLITE_BUSY || code == SQLITE_LOCKED) return;
    throw SQLite::Exception(sqlite.getHandle(), code);
  });
}

}  // namespace fathom
