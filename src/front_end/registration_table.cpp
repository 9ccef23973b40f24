#include "registration_table.hpp"

#include <array>
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

constexpr int kSchemaVersion = 1;

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

// Immutable: without locks, which a file system of several machines may not have. Not so where a
// process left its log of changes beside the file.
std::string uri_of(const fs::path& path) {
  std::string uri = "file:";
  for (const char letter : path.string()) {
    char code[4];
    std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(letter));
    const bool is_special = letter == '%' || letter == '?' || letter == '#';
    uri += is_special ? std::string(code) : std::string(1, letter);
  }
  std::error_code error;
  return fs::exists(path.string() + "-wal", error) ? uri : uri + "?immutable=1";
}

}  // namespace

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
  auto sqlite = std::make_unique<SQLite::Database>(
      uri_of(file), SQLite::OPEN_READONLY | SQLite::OPEN_URI, kRegistrationBusyMs);
  if (sqlite->execAndGet("PRAGMA user_version").getInt() != kSchemaVersion) {
    throw InputError("is no cache of registrations of this version");
  }
  return sqlite;
}

}  // namespace fathom
