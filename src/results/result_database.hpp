#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <type_traits>

#include "fathom/core/file_lock.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/results/result_store.hpp"
#include "result_schema.hpp"

namespace fathom {

/// Of waiting for another process.
inline constexpr int kBusyTimeoutMs = 10'000;

/// The open file of a store.
class ResultStore::Database {
 public:
  /// Throws InputError where the file cannot be opened. `flags` are those of SQLite.
  Database(const std::filesystem::path& file, int flags);

  /// Runs an action on the file; what SQLite throws, and what the file says wrongly, becomes bad
  /// input that names the file, or a fault of the environment.
  template <class Action>
  std::invoke_result_t<Action> guard(Action action) const {
    try {
      return action();
    } catch (const SQLite::Exception& error) {
      refuse(error);
    } catch (const DamagedStore& damage) {
      throw InputError(file.string(), damage.what());
    }
  }

  /// Whether the file is a store of this program; false of an empty one. Throws InputError on any
  /// other file.
  bool is_store() const;

  std::filesystem::path file;
  mutable std::optional<SQLite::Database> sqlite;
  std::unique_ptr<FileLock> lock;  ///< of a store that is written
  StudyDescription study;
  std::int64_t session = 0;  ///< of this process, where it writes
  std::mutex mutex;

 private:
  [[noreturn]] void refuse(const SQLite::Exception& error) const;
};

}  // namespace fathom
