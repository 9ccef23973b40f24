#include "registration_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>

#include "fathom/core/input_error.hpp"
#include "registration_row.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

// Version 1 had no column `used`.
constexpr int kSchemaVersion = 2;
constexpr int kPictureSchemaVersion = 1;

// Immutable: without locks, which a file system of several machines may not have. Not so where a
// process left its log of changes beside the file.
std::string uri_of(const fs::path& path) {
  // Behind two slashes a host would be expected.
  std::string uri = path.string().starts_with("//") ? "file://" : "file:";
  for (const char letter : path.string()) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(letter));
    const bool is_special = letter == '%' || letter == '?' || letter == '#';
    uri += is_special ? std::string(code) : std::string(1, letter);
  }
  std::error_code error;
  return fs::exists(path.string() + "-wal", error) ? uri : uri + "?immutable=1";
}

int version_of(SQLite::Database& sqlite) {
  return sqlite.execAndGet("PRAGMA user_version").getInt();
}

std::unique_ptr<SQLite::Database> open_immutable(const fs::path& file) {
  return std::make_unique<SQLite::Database>(uri_of(file), SQLite::OPEN_READONLY | SQLite::OPEN_URI,
                                            kRegistrationBusyMs);
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

// `change` makes a file of this version of one of another; 0: a new one.
template <class Change>
void prepare(SQLite::Database& sqlite, int version, const Change& change) {
  sqlite.exec("PRAGMA journal_mode = WAL");
  sqlite.exec("PRAGMA synchronous = NORMAL");
  if (version_of(sqlite) == version) return;
  SQLite::Transaction transaction(sqlite, SQLite::TransactionBehavior::IMMEDIATE);
  // Another process may have been quicker.
  const int before = version_of(sqlite);
  if (before == version) return;
  change(before);
  sqlite.exec("PRAGMA user_version = " + std::to_string(version));
  transaction.commit();
}

}  // namespace

void prepare_schema(SQLite::Database& sqlite) {
  prepare(sqlite, kSchemaVersion, [&](int version) {
    if (version == 1) {
      sqlite.exec("ALTER TABLE registration ADD COLUMN used INTEGER NOT NULL DEFAULT 0");
    } else {
      drop_all(sqlite);
      sqlite.exec(
          "CREATE TABLE registration (key BLOB PRIMARY KEY, found INTEGER NOT NULL, numbers BLOB "
          "NOT NULL, inliers INTEGER NOT NULL, checksum INTEGER NOT NULL, used INTEGER NOT NULL "
          "DEFAULT 0) WITHOUT ROWID");
    }
    sqlite.exec("CREATE INDEX registration_used ON registration (used)");
  });
}

void prepare_picture_schema(SQLite::Database& sqlite) {
  prepare(sqlite, kPictureSchemaVersion, [&](int) {
    drop_all(sqlite);
    sqlite.exec(
        "CREATE TABLE features (key BLOB NOT NULL UNIQUE, used INTEGER NOT NULL, bytes INTEGER NOT "
        "NULL, checksum INTEGER NOT NULL, content BLOB NOT NULL)");
  });
}

std::int64_t next_use(SQLite::Database& sqlite) {
  return 1 + sqlite.execAndGet("SELECT COALESCE(MAX(used), 0) FROM registration").getInt64();
}

std::uint64_t bytes_in(SQLite::Database& sqlite) {
  const auto pragma = [&](const char* text) {
    return static_cast<std::uint64_t>(sqlite.execAndGet(text).getInt64());
  };
  return (pragma("PRAGMA page_count") - pragma("PRAGMA freelist_count")) *
         pragma("PRAGMA page_size");
}

void remove_least_used(SQLite::Database& sqlite, std::uint64_t most_bytes, std::int64_t kept) {
  if (bytes_in(sqlite) <= most_bytes) return;
  SQLite::Transaction transaction(sqlite, SQLite::TransactionBehavior::IMMEDIATE);
  const double bytes = static_cast<double>(bytes_in(sqlite));
  const double share = 1.0 - 0.9 * static_cast<double>(most_bytes) / bytes;
  const double count = sqlite.execAndGet("SELECT COUNT(*) FROM registration").getDouble();
  SQLite::Statement remove(sqlite,
                           "DELETE FROM registration WHERE key IN (SELECT key FROM registration "
                           "WHERE used < ? ORDER BY used LIMIT ?)");
  remove.bind(1, kept);
  remove.bind(2, static_cast<std::int64_t>(std::ceil(std::max(share, 0.0) * count)));
  remove.exec();
  transaction.commit();
}

std::optional<PairRegistration> intact_row(SQLite::Statement& row, const RegistrationKey& key) {
  RegistrationNumbers numbers{};
  const SQLite::Column blob = row.getColumn(1);
  if (blob.getBytes() != sizeof numbers) return std::nullopt;
  std::memcpy(numbers.data(), blob.getBlob(), sizeof numbers);
  const PairRegistration read =
      registration_of(row.getColumn(0).getInt() != 0, numbers, row.getColumn(2).getInt());
  if (checksum(key, read) != row.getColumn(3).getInt64()) return std::nullopt;
  return read;
}

std::vector<std::pair<RegistrationKey, PairRegistration>> intact_rows(SQLite::Database& sqlite) {
  std::vector<std::pair<RegistrationKey, PairRegistration>> all;
  SQLite::Statement rows(sqlite, "SELECT found, numbers, inliers, checksum, key FROM registration");
  while (rows.executeStep()) {
    std::array<std::uint64_t, 2> words{};
    const SQLite::Column blob = rows.getColumn(4);
    if (blob.getBytes() != sizeof words) continue;
    std::memcpy(words.data(), blob.getBlob(), sizeof words);
    const RegistrationKey key{words[0], words[1]};
    if (const auto value = intact_row(rows, key)) all.emplace_back(key, *value);
  }
  return all;
}

std::unique_ptr<SQLite::Database> open_to_read(const fs::path& file) {
  auto sqlite = open_immutable(file);
  if (const int version = version_of(*sqlite); version != 1 && version != kSchemaVersion) {
    throw InputError("is no cache of registrations of this version");
  }
  return sqlite;
}

std::unique_ptr<SQLite::Database> open_pictures_to_read(const fs::path& file) {
  auto sqlite = open_immutable(file);
  if (version_of(*sqlite) != kPictureSchemaVersion) {
    throw InputError("is no cache of pictures of this version");
  }
  return sqlite;
}

}  // namespace fathom
