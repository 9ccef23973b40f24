#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// Of all waiting for another process.
inline constexpr int kRegistrationBusyMs = 5'000;

/// Makes the table; empties a file of another version of this program, or that is something else.
void prepare_schema(SQLite::Database& sqlite);

/// Opens a file of this version to read alone. Throws SQLite::Exception or InputError.
std::unique_ptr<SQLite::Database> open_to_read(const std::filesystem::path& file);

/// The columns found, numbers, inliers and checksum of a row; nothing where they are not what was
/// stored.
std::optional<PairRegistration> intact_row(SQLite::Statement& row, const RegistrationKey& key);

/// All rows but those that are damaged.
std::vector<std::pair<RegistrationKey, PairRegistration>> intact_rows(SQLite::Database& sqlite);

}  // namespace fathom
