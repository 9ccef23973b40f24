#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// Of all waiting for another process.
inline constexpr int kRegistrationBusyMs = 5'000;

/// Makes the table, or what an earlier version lacks; empties a file of another version of this
/// program, or that is something else.
void prepare_schema(SQLite::Database& sqlite);

/// The same of a file of pictures and features.
void prepare_picture_schema(SQLite::Database& sqlite);

/// One more than that of any row: rows that are used get it.
std::int64_t next_use(SQLite::Database& sqlite);

/// Of what is in the file, without the free room in it.
std::uint64_t bytes_in(SQLite::Database& sqlite);

/// Removes rows in the order of their last use until nine tenths of `most_bytes` are left, but none
/// of use `kept` or later. Removes none where the file holds no more than `most_bytes`.
void remove_least_used(SQLite::Database& sqlite, std::uint64_t most_bytes, std::int64_t kept);

/// Opens a file of this version to read alone. Throws SQLite::Exception or InputError.
std::unique_ptr<SQLite::Database> open_to_read(const std::filesystem::path& file);
std::unique_ptr<SQLite::Database> open_pictures_to_read(const std::filesystem::path& file);

/// The columns found, numbers, inliers and checksum of a row; nothing where they are not what was
/// stored.
std::optional<PairRegistration> intact_row(SQLite::Statement& row, const RegistrationKey& key);

/// All rows but those that are damaged.
std::vector<std::pair<RegistrationKey, PairRegistration>> intact_rows(SQLite::Database& sqlite);

}  // namespace fathom
