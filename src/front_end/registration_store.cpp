#include "fathom/front_end/registration_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <sqlite3.h>
#include <system_error>

#include "fathom/core/input_error.hpp"
#include "registration_row.hpp"
#include "registration_table.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSelect =
    "SELECT found, numbers, inliers, checksum FROM registration WHERE key = ?";
constexpr std::size_t kFlushCount = 200;
constexpr std::chrono::seconds kFlushInterval{1};

}  // namespace

class RegistrationStore::File {
 public:
  File(const fs::path& folder, std::uint64_t most_bytes)
      : path_(folder / kRegistrationsFile), most_bytes_(most_bytes) {
    if (folder.empty()) {
      problem_ = "no folder for the cache of registrations; set FATHOM_CACHE";
      return;
    }
    guard([&] {
      std::error_code error;
      fs::create_directories(folder, error);
      sqlite_ = std::make_unique<SQLite::Database>(
          path_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kRegistrationBusyMs);
      prepare_schema(*sqlite_);
      select_ = std::make_unique<SQLite::Statement>(*sqlite_, kSelect);
      insert_ = std::make_unique<SQLite::Statement>(
          *sqlite_, "INSERT OR REPLACE INTO registration VALUES (?, ?, ?, ?, ?, ?)");
      use_ = next_use(*sqlite_);
    });
  }

  // To read alone.
  static std::unique_ptr<File> read_only(const fs::path& folder) {
    std::unique_ptr<File> file(new File);
    file->path_ = folder / kRegistrationsFile;
    file->guard([&] {
      file->sqlite_ = open_to_read(file->path_);
      file->select_ = std::make_unique<SQLite::Statement>(*file->sqlite_, kSelect);
    });
    return file;
  }

  std::optional<PairRegistration> find(const RegistrationKey& key) {
    const std::lock_guard lock(mutex_);
    if (const auto found = unwritten_.find(key); found != unwritten_.end()) return found->second;
    std::optional<PairRegistration> value;
    guard([&] { value = select(key); });
    if (value && insert_ != nullptr) found_.push_back(key);
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

  std::vector<std::pair<RegistrationKey, PairRegistration>> all() {
    const std::lock_guard lock(mutex_);
    std::vector<std::pair<RegistrationKey, PairRegistration>> rows;
    guard([&] { rows = intact_rows(*sqlite_); });
    return rows;
  }

  // What was used is so noted, and what was not goes where there is too much.
  void close() {
    flush();
    const std::lock_guard lock(mutex_);
    if (insert_ == nullptr) return;
    guard([&] { note_used(); });
    if (most_bytes_ > 0) guard([&] { remove_least_used(*sqlite_, most_bytes_, use_); });
  }

  void finish() {
    flush();
    const std::lock_guard lock(mutex_);
    if (sqlite_) sqlite_->tryExec("PRAGMA journal_mode = DELETE");
  }

  std::string problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
  }

 private:
  File() = default;

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
    if (select_->executeStep()) value = intact_row(*select_, key);
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
    insert_->bind(6, use_);
    insert_->exec();
    insert_->reset();
  }

  void write() {
    last_flush_ = std::chrono::steady_clock::now();
    if (unwritten_.empty() || insert_ == nullptr) return;
    guard([&] {
      SQLite::Transaction transaction(*sqlite_, SQLite::TransactionBehavior::IMMEDIATE);
      for (const auto& [key, value] : unwritten_) insert(key, value);
      transaction.commit();
      unwritten_.clear();
    });
  }

  void note_used() {
    if (found_.empty()) return;
    SQLite::Transaction transaction(*sqlite_, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement update(*sqlite_,
                             "UPDATE registration SET used = ? WHERE key = ? AND used < ?");
    for (const RegistrationKey& key : found_) {
      const auto words = words_of(key);
      update.reset();
      update.bind(1, use_);
      update.bind(2, words.data(), sizeof words);
      update.bind(3, use_);
      update.exec();
    }
    transaction.commit();
  }

  fs::path path_;
  std::uint64_t most_bytes_ = 0;
  std::int64_t use_ = 0;
  std::vector<RegistrationKey> found_;  // in the file
  mutable std::mutex mutex_;
  std::string problem_;
  std::map<RegistrationKey, PairRegistration> unwritten_;
  std::chrono::steady_clock::time_point last_flush_ = std::chrono::steady_clock::now();
  std::unique_ptr<SQLite::Database> sqlite_;
  std::unique_ptr<SQLite::Statement> select_;  // after what they belong to
  std::unique_ptr<SQLite::Statement> insert_;
};

RegistrationStore::RegistrationStore(const fs::path& folder, std::uint64_t most_bytes)
    : file_(std::make_unique<File>(folder, most_bytes)) {}

RegistrationStore::RegistrationStore(std::unique_ptr<File> file) : file_(std::move(file)) {}

std::unique_ptr<RegistrationStore> RegistrationStore::read_only(const fs::path& folder) {
  if (!has_registrations(folder)) {
    throw InputError(folder.string(), std::string("there is no ") + kRegistrationsFile +
                                          "; 'fathom compare --only-registrations' and 'fathom "
                                          "merge' make it");
  }
  std::unique_ptr<RegistrationStore> store(new RegistrationStore(File::read_only(folder)));
  if (const std::string problem = store->problem(); !problem.empty()) throw InputError(problem);
  return store;
}

RegistrationStore::~RegistrationStore() {
  file_->close();
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

std::vector<std::pair<RegistrationKey, PairRegistration>> RegistrationStore::all() const {
  return file_->all();
}

void RegistrationStore::finish() {
  file_->finish();
}

std::string RegistrationStore::problem() const {
  return file_->problem();
}

}  // namespace fathom
