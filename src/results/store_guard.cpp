#include "store_guard.hpp"

#include <SQLiteCpp/VariadicBind.h>
#include <cctype>
#include <map>
#include <set>
#include <sqlite3.h>
#include <tuple>

#include "fathom/core/hash.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"
#include "result_schema.hpp"

namespace fathom {
namespace {

constexpr int kLongestValue = 256 << 20;  // bytes
// A manifest is a configuration and a description of the machine.
constexpr int kLongestManifest = 16 << 20;  // bytes
// As of configurations, with room.
constexpr double kMostCells = 1e5;
constexpr double kMostRepeats = 1e7;

// Kind, name and the text that made it, blanks aside.
using SchemaObject = std::tuple<std::string, std::string, std::string>;

std::string without_blanks(const std::string& text) {
  std::string rest;
  for (const char letter : text) {
    if (std::isspace(static_cast<unsigned char>(letter)) == 0) rest += letter;
  }
  return rest;
}

std::set<SchemaObject> schema_of(SQLite::Database& database) {
  std::set<SchemaObject> schema;
  SQLite::Statement rows(database, "SELECT type, name, sql FROM sqlite_master");
  while (rows.executeStep()) {
    schema.emplace(rows.getColumn(0).getString(), rows.getColumn(1).getString(),
                   without_blanks(rows.getColumn(2).getString()));
  }
  return schema;
}

std::set<SchemaObject> own_schema() {
  SQLite::Database own(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  own.exec(result_schema());
  return schema_of(own);
}

// Whether an estimator's files may lie below a folder of this name.
bool names_a_folder(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         printable(name) == name;
}

/// No value is longer while this lives; SQLite refuses those that are.
class LengthLimit {
 public:
  LengthLimit(SQLite::Database& database, int bytes)
      : handle_(database.getHandle()),
        before_(::sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, bytes)) {}
  ~LengthLimit() { ::sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, before_); }
  LengthLimit(const LengthLimit&) = delete;
  LengthLimit& operator=(const LengthLimit&) = delete;

 private:
  ::sqlite3* handle_;
  int before_;
};

// In the table `study`, so that stores with and without it have one schema.
std::string checksum_key(std::int64_t session) {
  return "checksum of session " + std::to_string(session);
}

std::string checksum_of(std::int64_t session, const std::string& manifest) {
  return std::to_string(Hash().add(session).add(manifest).value());
}

}  // namespace

void distrust(SQLite::Database& database) {
  ::sqlite3* const handle = database.getHandle();
  for (const auto& [option, value] :
       {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1}, std::pair{SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
        std::pair{SQLITE_DBCONFIG_ENABLE_TRIGGER, 0}, std::pair{SQLITE_DBCONFIG_ENABLE_VIEW, 0},
        std::pair{SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0}}) {
    ::sqlite3_db_config(handle, option, value, nullptr);
  }
  ::sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kLongestValue);
}

void require_own_schema(SQLite::Database& database) {
  static const std::set<SchemaObject> expected = own_schema();
  const std::set<SchemaObject> there = schema_of(database);
  for (const SchemaObject& object : there) {
    if (expected.contains(object)) continue;
    throw DamagedStore("is not as this program makes a store: its " + std::get<0>(object) + " " +
                       in_quotes(std::get<1>(object)) + " is another" + kRemedy);
  }
  if (there.size() < expected.size()) {
    throw DamagedStore("is not as this program makes a store: tables are missing" +
                       std::string(kRemedy));
  }
}

void require_own_types(SQLite::Database& database) {
  // By table: which column of a row, if any, holds another type than it says.
  std::map<std::string, std::string> wrong;
  SQLite::Statement columns(database,
                            "SELECT t.name, c.name, lower(c.type) FROM sqlite_master AS t, "
                            "pragma_table_info(t.name) AS c WHERE t.type = 'table'");
  while (columns.executeStep()) {
    const std::string column = columns.getColumn(1).getString();
    wrong[columns.getColumn(0).getString()] += " WHEN typeof(" + column + ") <> '" +
                                               columns.getColumn(2).getString() + "' THEN '" +
                                               column + "'";
  }
  for (const auto& [table, cases] : wrong) {
    SQLite::Statement row(database, "SELECT CASE" + cases + " END AS wrong FROM " + table +
                                        " WHERE wrong IS NOT NULL LIMIT 1");
    if (!row.executeStep()) continue;
    throw DamagedStore("is damaged: its table " + table + " has a " + row.getColumn(0).getString() +
                       " of another type" + kRemedy);
  }
}

void require_sound(const StudyDescription& study) {
  for (const StudyEstimator& estimator : study.estimators) {
    if (names_a_folder(estimator.name)) continue;
    throw DamagedStore("has an estimator called " + in_quotes(estimator.name) +
                       ", which is no name of a folder" + kRemedy);
  }
  double cells = 1.0;
  for (const StudyAxis& axis : study.axes) cells *= static_cast<double>(axis.labels.size());
  const double repeats = static_cast<double>(study.surveys) * static_cast<double>(study.trials);
  if (cells <= kMostCells && repeats <= kMostRepeats) return;
  throw DamagedStore("is of a study of " + number_text(cells) + " cells, " + number_text(repeats) +
                     " trials in each; expected at most " + number_text(kMostCells) + " and " +
                     number_text(kMostRepeats) + kRemedy);
}

std::int64_t insert_session(SQLite::Database& database, const std::string& manifest) {
  SQLite::Statement session(database, "INSERT INTO session (manifest) VALUES (?)");
  session.bind(1, manifest);
  session.exec();
  const std::int64_t number = database.getLastInsertRowid();
  SQLite::Statement checksum(database, "INSERT OR REPLACE INTO study VALUES (?, ?)");
  SQLite::bind(checksum, checksum_key(number), checksum_of(number, manifest));
  checksum.exec();
  return number;
}

std::vector<std::string> read_manifests(SQLite::Database& database) {
  // Told without reading it: the row's size is known before its content.
  const LengthLimit limit(database, kLongestManifest);
  std::map<std::string, std::string> words;
  SQLite::Statement study(database, "SELECT key, value FROM study");
  while (study.executeStep()) {
    words[study.getColumn(0).getString()] = study.getColumn(1).getString();
  }
  std::vector<std::string> all;
  SQLite::Statement sessions(database, "SELECT session, manifest FROM session ORDER BY session");
  while (sessions.executeStep()) {
    const std::int64_t number = sessions.getColumn(0).getInt64();
    all.push_back(sessions.getColumn(1).getString());
    const auto checksum = words.find(checksum_key(number));
    if (checksum == words.end() || checksum->second == checksum_of(number, all.back())) continue;
    throw DamagedStore("is damaged: the manifest of session " + std::to_string(number) +
                       " is not what was stored (its checksum differs)" + kRemedy);
  }
  return all;
}

}  // namespace fathom
