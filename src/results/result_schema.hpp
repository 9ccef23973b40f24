#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>

#include "fathom/results/result_store.hpp"

namespace fathom {

/// `PRAGMA user_version` of the files that this program writes.
inline constexpr int kResultSchemaVersion = 2;
/// `PRAGMA application_id`, "Fath": tells a store from any other SQLite file.
inline constexpr int kResultApplicationId = 0x46617468;

/// Makes all tables of an empty file and writes what the study is.
void create_schema(SQLite::Database& database, const StudyDescription& study);

/// A list of words as the table `study` holds it.
std::string words_text(const std::vector<std::string>& words);

/// Writes names and labels of the axes, which are no part of what tells studies apart.
void write_labels(SQLite::Database& database, const StudyDescription& study);

StudyDescription read_study(SQLite::Database& database);

/// What of two configurations differs, one line: "seed: 1 there, 2 here; …". Empty if nothing.
std::string difference(const StudyDescription& there, const StudyDescription& here);

/// Which files of their data differ, one line: "a/1.png has changed; …". Empty if none.
std::string data_difference(const StudyDescription& there, const StudyDescription& here);

}  // namespace fathom
