#include "settled_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <algorithm>
#include <array>
#include <sqlite3.h>
#include <string>
#include <system_error>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/file_lock.hpp"
#include "fathom/results/result_store.hpp"
#include "result_database.hpp"
#include "store_guard.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::array<fs::path, 3> logs_of(const fs::path& file) {
  return {file.string() + "-wal", file.string() + "-shm", file.string() + "-journal"};
}

// The first that reads brings the logs in; out of WAL no log is left.
void bring_logs_in(const fs::path& file) {
  SQLite::Database sqlite(file.string(), SQLite::OPEN_READWRITE, kBusyTimeoutMs);
  distrust(sqlite);
  sqlite.execAndGet("SELECT count(*) FROM sqlite_master");
  sqlite.execAndGet("PRAGMA journal_mode = DELETE");
}

}  // namespace

void settle_store(const fs::path& folder) {
  const fs::path file = folder / kResultsFile;
  const auto logs = logs_of(file);
  const auto is_there = [](const fs::path& path) { return fs::exists(path); };
  if (std::ranges::none_of(logs, is_there)) return;
  const FileLock lock(folder / "results.lock",
                      folder.string() +
                          ": another process is at work on this study; wait for it, or use "
                          "another --out");
  try {
    if (fs::exists(file)) bring_logs_in(file);
  } catch (const SQLite::Exception& error) {
    const int code = error.getErrorCode();
    if (code == SQLITE_NOTADB || code == SQLITE_CORRUPT) return;
    const bool is_read = code == SQLITE_BUSY || code == SQLITE_LOCKED;
    throw EnvironmentError(file.string(),
                           is_read ? "is being read by another process; wait for it, and run the "
                                     "same command again"
                                   : std::string("cannot be read or written: ") + error.what());
  }
  std::error_code ignored;
  for (const fs::path& log : logs) fs::remove(log, ignored);
}

}  // namespace fathom
