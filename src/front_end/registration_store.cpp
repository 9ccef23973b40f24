#include "fathom/front_end/registration_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <map>
#include <mutex>
#include <sqlite3.h>
#include <system_error>
#include <vector>

#include "registration_row.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "registrations.sqlite";
constexpr int kSchemaVersion = 1;
constexpr int kBusyTimeoutMs = 5'000;
constexpr std::size_t kFlushCount = 200;
constexpr std::chrono::seconds kFlushInterval{1};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Whatever was there: other versions of this program, or something else that took the name.
void drop_all(SQLite::Database& sqlite) {
  std::vector<std::string> objects;
  SQLite::Statement query(sqlite,
                          "SELECT type || ' \"' || replace(name, '\"', '\"\"') || '\"' FROM "
                          "sqlite_master WHERE type IN ('table', 'view') AND name NOT LIKE "
                          "'sqlite\\_%' ESCAPE '\\'");
  while (query.executeStep()) objects.push_back(query.getColumn(0).getString());
  query.reset();
  for (const std::string& object : objects) sqlite.exec("DROP " + object);
}

void prepare_schema(SQLite::Database& sqlite) {
  sqlite.exec("PRAGMA journal_mode = WAL");
  sqlite.exec("PRAGMA synchronous = NORMAL");
  const auto is_ours = [&] {
    return sqlite.execAndGet("PRAGMA user_version").getInt() == kSchemaVersion;
  };
  if (is_ours()) return;
  SQLite::Transaction transaction(sqlite, SQLite::TransactionBehavior::IMMEDIATE);
  if (is_ours()) return;  // another process was quicker
  drop_all(sqlite);
  sqlite.exec(
      "CREATE TABLE registration (key BLOB PRIMARY KEY, found INTEGER NOT NULL, "
      "numbers BLOB NOT NULL, inliers INTEGER NOT NULL, checksum INTEGER NOT NULL) WITHOUT ROWID");
  sqlite.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  transaction.commit();
}

}  // namespace

fs::path default_cache_folder() {
  if (const std::string own = environment("FATHOM_CACHE"); !own.empty()) return own;
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) {
    return fs::path(xdg) / "fathom";
  }
  if (const std::string home = environment("HOME"); !home.empty()) {
    return fs::path(home) / ".cache" / "fathom";
  }
  return {};
}

class RegistrationStore::File {
 public:
  explicit File(const fs::path& folder) : path_(folder / kFileName) {
    if (folder.empty()) {
      problem_ = "no folder for the cache of registrations; set FATHOM_CACHE";
      return;
    }
    guard([&] {
      std::error_code error;
      fs::create_directories(folder, error);
      sqlite_ = std::make_unique<SQLite::Database>(
          path_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeoutMs);
      prepare_schema(*sqlite_);
      select_ = std::make_unique<SQLite::Statement>(
          *sqlite_, "SELECT found, numbers, inliers, checksum FROM registration WHERE key = ?");
      insert_ = std::make_unique<SQLite::Statement>(
          *sqlite_, "INSERT OR REPLACE INTO registration VALUES (?, ?, ?, ?, ?)");
    });
  }

  std::optional<PairRegistration> find(const RegistrationKey& key) {
    const std::lock_guard lock(mutex_);
    if (const auto found = unwritten_.find(key); found != unwritten_.end()) return found->second;
    std::optional<PairRegistration> value;
    guard([&] { value = select(key); });
    return value;
  }

  void put(const RegistrationKey& key, const PairRegistration& value) {
    const std::lock_guard lock(mutex_);
    unwritten_[key] = value;
    const auto since = std::chrono::steady_clock::now() - last_flush_;
    if (unwritten_.size() >= kFlushCount || since >= kFlushInterval) write();
  }

  void flush() {
    const std::lock_guard lock(mutex_);
    write();
  }

  std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

 private:
  // What goes wrong closes the file: what is not written stays in memory, as all that follows.
  template <class Action>
  void guard(Action action) {
    if (!problem_.empty()) return;
    try {
      action();
    } catch (const SQLite::Exception& error) {
      // Another process has it for long. The next time it may be free.
      if (error.getErrorCode() == SQLITE_BUSY && insert_ != nullptr) return;
      give_up(error.what());
    } catch (const std::exception& error) {
      give_up(error.what());
    }
  }

  void give_up(const std::string& why) {
    problem_ = path_.string() + ": " + why +
               "; registrations are kept in memory only. Remove the file if it is damaged";
    select_.reset();
    insert_.reset();
    sqlite_.reset();
  }

  std::optional<PairRegistration> select(const RegistrationKey& key) {
    const auto words = words_of(key);
    select_->reset();
    select_->bind(1, words.data(), sizeof words);
    std::optional<PairRegistration> value;
    if (select_->executeStep()) {
      RegistrationNumbers numbers{};
      const SQLite::Column blob = select_->getColumn(1);
      if (blob.getBytes() == sizeof numbers) {
        std::memcpy(numbers.data(), blob.getBlob(), sizeof numbers);
        const PairRegistration read = registration_of(select_->getColumn(0).getInt() != 0, numbers,
                                                      select_->getColumn(2).getInt());
        if (checksum(key, read) == select_->getColumn(3).getInt64()) value = read;
      }
    }
    select_->reset();
    return value;
  }

  void insert(const RegistrationKey& key, const PairRegistration& value) {
    const auto words = words_of(key);
    const RegistrationNumbers numbers = numbers_of(value);
    insert_->reset();
    insert_->bind(1, words.data(), sizeof words);
    insert_->bind(2, value.found ? 1 : 0);
    insert_->bind(3, numbers.data(), sizeof numbers);
    insert_->bind(4, value.inliers);
    insert_->bind(5, checksum(key, value));
    insert_->exec();
    insert_->reset();
  }

  void write() {
    last_flush_ = std::chrono::steady_clock::now();
    if (unwritten_.empty()) return;
    guard([&] {
      SQLite::Transaction transaction(*sqlite_, SQLite::TransactionBehavior::IMMEDIATE);
      for (const auto& [key, value] : unwritten_) insert(key, value);
      transaction.commit();
      unwritten_.clear();
    });
  }

  const fs::path path_;
  mutable std::mutex mutex_;
  std::string problem_;
  std::map<RegistrationKey, PairRegistration> unwritten_;
  std::chrono::steady_clock::time_point last_flush_ = std::chrono::steady_clock::now();
  std::unique_ptr<SQLite::Database> sqlite_;
  std::unique_ptr<SQLite::Statement> select_;  // after what they belong to
  std::unique_ptr<SQLite::Statement> insert_;
};

RegistrationStore::RegistrationStore(const fs::path& folder)
    : file_(std::make_unique<File>(folder)) {}

RegistrationStore::~RegistrationStore() {
  file_->flush();
}

std::optional<PairRegistration> RegistrationStore::find(const RegistrationKey& key) {
  return file_->find(key);
}

void RegistrationStore::put(const RegistrationKey& key, const PairRegistration& value) {
  file_->put(key, value);
}

void RegistrationStore::flush() {
  file_->flush();
}

std::string RegistrationStore::problem() const {
  return file_->problem();
}

}  // namespace fathom
