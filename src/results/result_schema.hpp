#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <stdexcept>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// `PRAGMA user_version` of the files that this program writes.
inline constexpr int kResultSchemaVersion = 4;
/// `PRAGMA application_id`, "Fath": tells a store from any other SQLite file.
inline constexpr int kResultApplicationId = 0x46617468;

/// A store says what it cannot have been told: a bit flipped, or somebody edited it. The message
/// goes behind the file's name.
class DamagedStore : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The end of such a message.
inline constexpr const char* kRemedy =
    "; take the file from a copy, or remove it and run the study again";

/// What makes the tables of a store.
const char* result_schema();

/// Makes all tables of an empty file and writes what the study is.
void create_schema(SQLite::Database& database, const StudyDescription& study);

/// Writes what of a study may change without touching its results: title, metrics, the names and
/// labels of its axes, and the numbers of surveys and trials, which only grow.
void update_study(SQLite::Database& database, const StudyDescription& study);

/// Throws DamagedStore where that is not what was written.
StudyDescription read_study(SQLite::Database& database);

/// What of two configurations differs, one line: "seed: 1 there, 2 here; …". Empty if nothing.
std::string difference(const StudyDescription& there, const StudyDescription& here);

/// Throws InputError that names the file and what differs, unless configuration and data are the
/// same.
void require_same(const StudyDescription& there, const StudyDescription& here,
                  const std::filesystem::path& file);

/// Which files of their data differ, one line: "a/1.png has changed; …". Empty if none.
std::string data_difference(const StudyDescription& there, const StudyDescription& here);

}  // namespace fathom
