// The cache of registrations that all commands share unless told otherwise.

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdlib>
#include <sqlite3.h>
#include <system_error>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/front_end/picture_store.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "registration_table.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool is_damage(const SQLite::Exception& error) {
  return error.getErrorCode() == SQLITE_CORRUPT || error.getErrorCode() == SQLITE_NOTADB;
}

std::string how_to_clear(const fs::path& folder) {
  return "'fathom cache --clear --cache " + shell_word(folder.string()) + "' removes it";
}

template <class Open>
std::uint64_t count_in(const fs::path& folder, const char* name, const std::string& table,
                       const Open& open) {
  const fs::path file = folder / name;
  try {
    const auto count = open(file)->execAndGet("SELECT COUNT(*) FROM " + table).getInt64();
    return static_cast<std::uint64_t>(count);
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error)) throw EnvironmentError(file.string() + ": " + error.what());
    throw InputError(file.string(),
                     std::string("is damaged: ") + error.what() + "; " + how_to_clear(folder));
  } catch (const InputError& error) {
    throw InputError(file.string(), error.what() + ("; " + how_to_clear(folder)));
  }
}

template <class Prepare>
void clear(const fs::path& file, const std::string& table, const Prepare& prepare) {
  try {
    SQLite::Database sqlite(file.string(), SQLite::OPEN_READWRITE, kRegistrationBusyMs);
    prepare(sqlite);
    sqlite.exec("DELETE FROM " + table);
    sqlite.exec("VACUUM");
    sqlite.exec("PRAGMA wal_checkpoint(TRUNCATE)");
    return;
  } catch (const SQLite::Exception& error) {
    if (!is_damage(error)) throw EnvironmentError(file.string() + ": " + error.what());
  }
  // Nobody can read it.
  for (const char* const ending : {"", "-wal", "-shm"}) {
    std::error_code error;
    fs::remove(file.string() + ending, error);
    if (error) throw EnvironmentError(file.string() + ending + ": " + error.message());
  }
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

std::uint64_t default_cache_bytes() {
  constexpr double kDefaultMb = 1000.0;
  const std::string text = environment("FATHOM_CACHE_MB");
  if (text.empty()) return static_cast<std::uint64_t>(kDefaultMb * 1e6);
  const std::optional<double> megabytes = parse_real(text);
  if (!megabytes || !(*megabytes >= 1.0 && *megabytes <= 1e9)) {
    throw InputError("FATHOM_CACHE_MB: expected megabytes, 1 to 1e9, got '" + text + "'");
  }
  return static_cast<std::uint64_t>(*megabytes * 1e6);
}

CacheContent cache_content(const fs::path& folder) {
  CacheContent content;
  for (const char* const name : {kRegistrationsFile, kPicturesFile}) {
    for (const char* const ending : {"", "-wal"}) {
      std::error_code error;
      const std::uintmax_t bytes = fs::file_size((folder / name).string() + ending, error);
      if (!error) content.bytes += bytes;
    }
  }
  if (has_registrations(folder)) {
    content.registrations = count_in(folder, kRegistrationsFile, "registration", open_to_read);
  }
  if (has_pictures(folder)) {
    content.pictures = count_in(folder, kPicturesFile, "features", open_pictures_to_read);
  }
  return content;
}

void clear_cache(const fs::path& folder) {
  if (has_registrations(folder)) {
    clear(folder / kRegistrationsFile, "registration", prepare_schema);
  }
  if (has_pictures(folder)) {
    clear(folder / kPicturesFile, "features", prepare_picture_schema);
  }
}

std::unique_ptr<RegistrationStore> RegistrationStore::usual() {
  const fs::path folder = default_cache_folder();
  const std::uint64_t half = default_cache_bytes() / 2;
  auto store = std::make_unique<RegistrationStore>(folder, half);
  store->pictures_ = std::make_unique<PictureStore>(folder, half);
  return store;
}

}  // namespace fathom
