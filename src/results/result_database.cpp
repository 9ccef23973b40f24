#include "result_database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include "fathom/core/environment_error.hpp"
#include "store_guard.hpp"

namespace fathom {

ResultStore::Database::Database(const std::filesystem::path& path, int flags) : file(path) {
  guard([&] {
    sqlite.emplace(file.string(), flags, kBusyTimeoutMs);
    distrust(*sqlite);
  });
}

bool ResultStore::Database::is_store() const {
  const int id = sqlite->execAndGet("PRAGMA application_id").getInt();
  const int version = sqlite->execAndGet("PRAGMA user_version").getInt();
  const int tables = sqlite->execAndGet("SELECT count(*) FROM sqlite_master").getInt();
  if (tables == 0 && id == 0) return false;
  if (id != kResultApplicationId) {
    throw InputError(file.string(), "is a database, but no result store of Fathom");
  }
  if (version != kResultSchemaVersion) {
    throw InputError(
        file.string(),
        fmt::format("has schema version {}, this program has {}; use the program that wrote it",
                    version, kResultSchemaVersion));
  }
  require_own_schema(*sqlite);
  require_own_types(*sqlite);
  return true;
}

void ResultStore::Database::refuse(const SQLite::Exception& error) const {
  switch (error.getErrorCode()) {
    case SQLITE_FULL:
      throw EnvironmentError(file.string(),
                             "the disk is full; nothing of the unfinished run was stored. Make "
                             "room and run the same command again");
    case SQLITE_TOOBIG:
      throw InputError(file.string(), "holds a value that is longer than any that is stored");
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      throw InputError(file.string(),
                       std::string("is no result store, or a damaged one: ") + error.what());
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_IOERR:
      throw EnvironmentError(file.string(),
                             std::string("cannot be read or written: ") + error.what());
    case SQLITE_NOMEM:
      throw EnvironmentError(file.string(), error.what());
    default:
      throw InputError(file.string(), error.what());
  }
}

}  // namespace fathom
