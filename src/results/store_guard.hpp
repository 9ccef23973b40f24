#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// A store may be anybody's. SQLite is told so: no trigger, view or function of the file's schema
/// runs, no value is longer than 256 MiB, no manifest than 16 MiB.
void distrust(SQLite::Database& database);

/// Throws DamagedStore where the file has a table, index, view or trigger that a store has not, or
/// one that is written otherwise.
void require_own_schema(SQLite::Database& database);

/// Throws DamagedStore where a value is not of the type of its column, which SQLite keeps as it is
/// and converts, 'abc' to 0, when it is read. Of a file with the schema of a store.
void require_own_types(SQLite::Database& database);

/// Throws DamagedStore where names could leave the study's folder, or sizes are none that a
/// configuration may have.
void require_sound(const StudyDescription& study);

/// Appends a session; returns its number.
std::int64_t insert_session(SQLite::Database& database, const std::string& manifest);

/// The manifests of all sessions, in their order. Throws DamagedStore where one is not what was
/// stored; those of stores without checksums of manifests are taken as they are.
std::vector<std::string> read_manifests(SQLite::Database& database);

}  // namespace fathom
