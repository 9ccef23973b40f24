#include "fathom/front_end/picture_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <exception>
#include <mutex>
#include <sqlite3.h>
#include <string>
#include <string_view>
#include <vector>

#include "fathom/core/hash.hpp"
#include "registration_row.hpp"
#include "registration_table.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::int64_t checksum(const RegistrationKey& key, std::string_view content) {
  return static_cast<std::int64_t>(Hash().add(key.first).add(key.second).add(content).value());
}

}  // namespace

class PictureStore::File {
 public:
  File(const fs::path& folder, std::uint64_t most_bytes) : most_bytes_(most_bytes) {
    if (folder.empty()) return;
    is_open_ = true;
    guard([&] {
      fs::create_directories(folder);
      sqlite_ = std::make_unique<SQLite::Database>((folder / kPicturesFile).string(),
                                                   SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE,
                                                   kRegistrationBusyMs);
      prepare_picture_schema(*sqlite_);
      use_ = 1 + number("SELECT COALESCE(MAX(used), 0) FROM features");
    });
  }

  std::optional<std::string> find(const RegistrationKey& key) {
    const auto words = words_of(key);
    std::optional<std::string> found;
    guard([&] {
      SQLite::Statement select(*sqlite_, "SELECT checksum, content FROM features WHERE key = ?");
      select.bind(1, words.data(), sizeof words);
      if (!select.executeStep()) return;
      const SQLite::Column blob = select.getColumn(1);
      const std::string_view content(static_cast<const char*>(blob.getBlob()),
                                     static_cast<std::size_t>(blob.getBytes()));
      if (checksum(key, content) != select.getColumn(0).getInt64()) return;
      found.emplace(content);
      found_.push_back(key);
    });
    return found;
  }

  void put(const RegistrationKey& key, std::string_view content) {
    const auto words = words_of(key);
    guard([&] {
      if (is_full_ || content.size() > most_bytes_) return;
      SQLite::Transaction transaction(*sqlite_, SQLite::TransactionBehavior::IMMEDIATE);
      is_full_ = !make_room_for(content.size());
      if (is_full_) return;
      SQLite::Statement insert(*sqlite_, "INSERT OR REPLACE INTO features VALUES (?, ?, ?, ?, ?)");
      insert.bind(1, words.data(), sizeof words);
      insert.bind(2, use_);
      insert.bind(3, static_cast<std::int64_t>(content.size()));
      insert.bind(4, checksum(key, content));
      insert.bindNoCopy(5, content.data(), static_cast<int>(content.size()));
      insert.exec();
      transaction.commit();
    });
  }

  void close() {
    if (found_.empty()) return;
    guard([&] {
      SQLite::Transaction transaction(*sqlite_, SQLite::TransactionBehavior::IMMEDIATE);
      SQLite::Statement update(*sqlite_, "UPDATE features SET used = MAX(used, ?) WHERE key = ?");
      for (const RegistrationKey& key : found_) {
        const auto words = words_of(key);
        update.reset();
        update.bind(1, use_);
        update.bind(2, words.data(), sizeof words);
        update.exec();
      }
      transaction.commit();
    });
  }

 private:
  // What goes wrong closes the file, but not that another process has it for long.
  template <class Action>
  void guard(Action action) {
    const std::lock_guard lock(mutex_);
    if (!is_open_) return;
    try {
      action();
    } catch (const std::exception& error) {
      const auto* sqlite = dynamic_cast<const SQLite::Exception*>(&error);
      if (sqlite != nullptr && sqlite->getErrorCode() == SQLITE_BUSY && use_ > 0) return;
      is_open_ = false;
    }
  }

  std::int64_t number(const char* query) { return sqlite_->execAndGet(query).getInt64(); }

  bool make_room_for(std::uint64_t bytes) {
    constexpr const char* kHeld = "SELECT COALESCE(SUM(bytes), 0) FROM features";
    const auto has_room = [&] {
      return static_cast<std::uint64_t>(number(kHeld)) + bytes <= most_bytes_;
    };
    // A tenth at once, so that room is seldom looked for.
    SQLite::Statement remove(
        *sqlite_,
        "DELETE FROM features WHERE rowid IN (SELECT rowid FROM features WHERE "
        "used < ? ORDER BY used LIMIT (SELECT 1 + COUNT(*) / 10 FROM features))");
    remove.bind(1, use_);
    while (!has_room()) {
      if (remove.exec() == 0) return false;
      remove.reset();
    }
    return true;
  }

  std::uint64_t most_bytes_;
  std::mutex mutex_;
  bool is_open_ = false;
  bool is_full_ = false;  // of what this process uses
  std::int64_t use_ = 0;
  std::vector<RegistrationKey> found_;
  std::unique_ptr<SQLite::Database> sqlite_;
};

PictureStore::PictureStore(const fs::path& folder, std::uint64_t most_bytes)
    : file_(std::make_unique<File>(folder, most_bytes)) {}

PictureStore::~PictureStore() {
  file_->close();
}

std::optional<std::string> PictureStore::find(const RegistrationKey& key) {
  return file_->find(key);
}

void PictureStore::put(const RegistrationKey& key, std::string_view bytes) {
  file_->put(key, bytes);
}

}  // namespace fathom
