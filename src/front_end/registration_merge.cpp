#include <SQLiteCpp/SQLiteCpp.h>
#include <set>
#include <sqlite3.h>
#include <string>
#include <system_error>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "registration_table.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

bool has_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

// What a process that was killed left in SQLite's log comes into the file, and no log stays, which
// SQLite would apply to the file that takes its place. One that is damaged is left to its reader.
void settle(const fs::path& file) {
  const auto log = [&file](const char* ending) { return fs::path(file.string() + ending); };
  try {
    if (has_file(file) && (has_file(log("-wal")) || has_file(log("-journal")))) {
      SQLite::Database sqlite(file.string(), SQLite::OPEN_READWRITE, kRegistrationBusyMs);
      sqlite.execAndGet("SELECT count(*) FROM sqlite_master");
      sqlite.execAndGet("PRAGMA journal_mode = DELETE");
    }
  } catch (const SQLite::Exception& error) {
    if (error.getErrorCode() != SQLITE_BUSY) return;
    throw EnvironmentError(
        file.string(), "is in use by another process; wait for it, or merge into another --out");
  }
  std::error_code ignored;
  for (const char* ending : {"-wal", "-shm", "-journal"}) fs::remove(log(ending), ignored);
}

}  // namespace

bool has_registrations(const fs::path& folder) {
  return has_file(folder / kRegistrationsFile);
}

bool has_pictures(const fs::path& folder) {
  return has_file(folder / kPicturesFile);
}

MergedRegistrations merge_registrations(const std::vector<fs::path>& folders, const fs::path& out) {
  settle(out / kRegistrationsFile);
  std::vector<fs::path> sources = folders;
  if (has_registrations(out)) sources.push_back(out);
  StagedFolder staged(out);
  MergedRegistrations merged;
  {
    RegistrationStore all(staged.path());
    std::set<fs::path> seen;
    for (const fs::path& folder : sources) {
      if (!seen.insert(fs::weakly_canonical(folder)).second) continue;
      const auto source = RegistrationStore::read_only(folder);
      for (const auto& [key, value] : source->all()) {
        if (const auto there = all.find(key)) {
          if (!(*there == value)) {
            throw InputError(folder.string(),
                             "has another registration of a pair of pictures than the caches "
                             "before it; the same pair gives the same registration on "
                             "processors of one kind: find out which one is wrong, or made by "
                             "another kind, and make it again");
          }
          ++merged.repeated;
          continue;
        }
        all.put(key, value);
        ++merged.count;
      }
      if (const std::string problem = source->problem(); !problem.empty()) {
        throw InputError(problem);
      }
    }
    all.finish();
    if (const std::string problem = all.problem(); !problem.empty()) throw InputError(problem);
  }
  staged.commit();
  return merged;
}

}  // namespace fathom
