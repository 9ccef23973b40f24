#include "result_schema.hpp"

#include <algorithm>

#include "fathom/core/hash.hpp"
#include "fathom/core/text.hpp"
#include "store_guard.hpp"

namespace fathom {
namespace {

// docs/outputs.md says what each column means.
constexpr const char* kSchema = R"sql(
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE configuration (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE data_file (file TEXT PRIMARY KEY, hash TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE axis (axis INTEGER PRIMARY KEY, name TEXT NOT NULL, key TEXT NOT NULL);
CREATE TABLE axis_value (axis INTEGER NOT NULL REFERENCES axis, place INTEGER NOT NULL,
                         value TEXT NOT NULL, label TEXT NOT NULL,
                         PRIMARY KEY (axis, place)) WITHOUT ROWID;
CREATE TABLE cell (cell INTEGER PRIMARY KEY, label TEXT NOT NULL, association TEXT NOT NULL,
                   alignment TEXT NOT NULL);
CREATE TABLE cell_value (cell INTEGER NOT NULL REFERENCES cell,
                         axis INTEGER NOT NULL REFERENCES axis,
                         place INTEGER NOT NULL, PRIMARY KEY (cell, axis)) WITHOUT ROWID;
CREATE TABLE estimator (estimator INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE,
                        type TEXT NOT NULL);
CREATE TABLE metric (metric INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE,
                     is_cost INTEGER NOT NULL);
CREATE TABLE session (session INTEGER PRIMARY KEY, manifest TEXT NOT NULL);
CREATE TABLE run (run INTEGER PRIMARY KEY, cell INTEGER NOT NULL REFERENCES cell,
                  survey INTEGER NOT NULL, trial INTEGER NOT NULL,
                  estimator INTEGER NOT NULL REFERENCES estimator,
                  outcome TEXT NOT NULL, fault TEXT NOT NULL, log_hash TEXT NOT NULL,
                  jobs INTEGER NOT NULL,
                  session INTEGER NOT NULL REFERENCES session, checksum INTEGER NOT NULL,
                  UNIQUE (cell, survey, trial, estimator));
CREATE TABLE value (run INTEGER NOT NULL REFERENCES run, metric INTEGER NOT NULL REFERENCES metric,
                    value REAL NOT NULL, PRIMARY KEY (run, metric)) WITHOUT ROWID;
CREATE TABLE series (run INTEGER NOT NULL REFERENCES run, name TEXT NOT NULL,
                     data BLOB NOT NULL, PRIMARY KEY (run, name)) WITHOUT ROWID;
CREATE VIEW result AS
  SELECT cell.label AS cell, cell.association AS association, cell.alignment AS alignment,
         run.survey AS survey, run.trial AS trial, estimator.name AS estimator,
         run.outcome AS outcome, metric.name AS metric,
         value.value AS value
  FROM value JOIN run USING (run) JOIN cell USING (cell) JOIN estimator USING (estimator)
       JOIN metric USING (metric);
)sql";

using Words = std::vector<std::pair<std::string, std::string>>;

void insert_words(SQLite::Database& database, const std::string& table, const Words& words) {
  SQLite::Statement insert(database, "INSERT INTO " + table + " VALUES (?, ?)");
  for (const auto& [key, value] : words) {
    insert.bind(1, key);
    insert.bind(2, value);
    insert.exec();
    insert.reset();
  }
}

template <class... Values>
void run_with(SQLite::Statement& insert, const Values&... values) {
  SQLite::bind(insert, values...);
  insert.exec();
  insert.reset();
}

std::int64_t number(std::size_t value) {
  return static_cast<std::int64_t>(value);
}

void insert_axes(SQLite::Database& database, const StudyDescription& study) {
  SQLite::Statement axis(database, "INSERT INTO axis VALUES (?, ?, ?)");
  SQLite::Statement axis_value(database, "INSERT INTO axis_value VALUES (?, ?, ?, ?)");
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    const StudyAxis& described = study.axes[a];
    run_with(axis, number(a), described.name, described.key);
    for (std::size_t place = 0; place < described.labels.size(); ++place) {
      run_with(axis_value, number(a), number(place), described.written_values()[place],
               described.labels[place]);
    }
  }
}

void insert_cells(SQLite::Database& database, const StudyDescription& study) {
  SQLite::Statement cell(database, "INSERT INTO cell VALUES (?, ?, ?, ?)");
  SQLite::Statement cell_value(database, "INSERT INTO cell_value VALUES (?, ?, ?)");
  for (std::size_t c = 0; c < study.cell_count(); ++c) {
    run_with(cell, number(c), study.label_of(c), study.association_of(c), study.alignment_of(c));
    const std::vector<std::size_t> places = study.places_of(c);
    for (std::size_t a = 0; a < places.size(); ++a) {
      run_with(cell_value, number(c), number(a), number(places[a]));
    }
  }
}

void update_labels(SQLite::Database& database, const StudyDescription& study) {
  SQLite::Statement axis(database, "UPDATE axis SET name = ? WHERE axis = ?");
  SQLite::Statement value(database, "UPDATE axis_value SET label = ? WHERE axis = ? AND place = ?");
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    run_with(axis, study.axes[a].name, number(a));
    for (std::size_t place = 0; place < study.axes[a].labels.size(); ++place) {
      run_with(value, study.axes[a].labels[place], number(a), number(place));
    }
  }
  SQLite::Statement cell(database, "UPDATE cell SET label = ? WHERE cell = ?");
  for (std::size_t c = 0; c < study.cell_count(); ++c) {
    run_with(cell, study.label_of(c), number(c));
  }
}

// Over what tables and charts are made from, to tell a flipped bit.
std::string checksum_of(const StudyDescription& study) {
  Hash hash;
  hash.add(study.title).add(study.alignment).add(study.surveys).add(study.trials);
  hash.add(joined(study.metrics, " "));
  // Stores without a margin have the default.
  if (study.margin != StudyDescription().margin) hash.add(exact(study.margin));
  for (const StudyAxis& axis : study.axes) {
    hash.add(axis.name).add(axis.key);
    for (const std::string& label : axis.labels) hash.add(label);
    for (const std::string& value : axis.written_values()) hash.add(value);
  }
  for (const StudyEstimator& estimator : study.estimators) {
    hash.add(estimator.name).add(estimator.type);
  }
  for (const auto& [key, value] : study.configuration) hash.add(key).add(value);
  for (const auto& [file, content] : study.data) hash.add(file).add(content);
  return std::to_string(hash.value());
}

Words read_words(SQLite::Database& database, const std::string& query) {
  Words words;
  SQLite::Statement select(database, query);
  while (select.executeStep()) {
    words.emplace_back(select.getColumn(0).getString(), select.getColumn(1).getString());
  }
  return words;
}

std::string study_word(SQLite::Database& database, const std::string& key) {
  SQLite::Statement select(database, "SELECT value FROM study WHERE key = ?");
  select.bind(1, key);
  return select.executeStep() ? select.getColumn(0).getString() : "";
}

// `what`: "surveys" or "trials".
std::size_t study_count(SQLite::Database& database, const std::string& what) {
  const std::string text = study_word(database, what);
  const auto count = parse_integer(text);
  if (!count || *count < 0) {
    throw DamagedStore("is damaged: its number of " + what + " is " + in_quotes(text) + kRemedy);
  }
  return static_cast<std::size_t>(*count);
}

// As it stands in the file, not yet compared with its checksum.
StudyDescription stored_study(SQLite::Database& database) {
  StudyDescription study;
  study.title = study_word(database, "title");
  study.alignment = study_word(database, "alignment");
  const std::string metrics = study_word(database, "metrics");
  for (const auto metric : split(metrics, " ")) study.metrics.emplace_back(metric);
  study.margin = parse_real(study_word(database, "margin")).value_or(study.margin);
  study.surveys = study_count(database, "surveys");
  study.trials = study_count(database, "trials");
  SQLite::Statement axes(database, "SELECT name, key FROM axis ORDER BY axis");
  while (axes.executeStep()) {
    study.axes.push_back({axes.getColumn(0).getString(), axes.getColumn(1).getString(), {}, {}});
  }
  SQLite::Statement places(database,
                           "SELECT axis, value, label FROM axis_value ORDER BY axis, place");
  while (places.executeStep()) {
    const std::size_t axis = places.getColumn(0).getUInt();
    if (axis >= study.axes.size()) {
      throw DamagedStore("is damaged: it has values of an axis that it has not" +
                         std::string(kRemedy));
    }
    study.axes[axis].values.push_back(places.getColumn(1).getString());
    study.axes[axis].labels.push_back(places.getColumn(2).getString());
  }
  SQLite::Statement estimators(
      database, "SELECT name, type FROM estimator WHERE estimator > 0 ORDER BY estimator");
  while (estimators.executeStep()) {
    study.estimators.push_back(
        {estimators.getColumn(0).getString(), estimators.getColumn(1).getString()});
  }
  study.configuration = read_words(database, "SELECT key, value FROM configuration ORDER BY key");
  study.data = read_words(database, "SELECT file, hash FROM data_file ORDER BY file");
  return study;
}

}  // namespace

const char* result_schema() {
  return kSchema;
}

void create_schema(SQLite::Database& database, const StudyDescription& study) {
  database.exec(kSchema);
  insert_words(database, "study",
               {{"title", study.title},
                {"alignment", study.alignment},
                {"metrics", joined(study.metrics, " ")},
                {"margin", exact(study.margin)},
                {"surveys", std::to_string(study.surveys)},
                {"trials", std::to_string(study.trials)},
                {"checksum", ""}});
  insert_words(database, "configuration", study.configuration);
  insert_words(database, "data_file", study.data);
  insert_axes(database, study);
  insert_cells(database, study);
  SQLite::Statement estimator(database, "INSERT INTO estimator VALUES (?, ?, ?)");
  run_with(estimator, 0, std::string(kDeadReckoning), std::string());
  for (std::size_t e = 0; e < study.estimators.size(); ++e) {
    run_with(estimator, number(e + 1), study.estimators[e].name, study.estimators[e].type);
  }
  database.exec("PRAGMA application_id = " + std::to_string(kResultApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kResultSchemaVersion));
}

void update_study(SQLite::Database& database, const StudyDescription& study) {
  const std::size_t surveys = std::max(study.surveys, study_count(database, "surveys"));
  const std::size_t trials = std::max(study.trials, study_count(database, "trials"));
  SQLite::Statement update(database, "UPDATE study SET value = ? WHERE key = ?");
  run_with(update, study.title, std::string("title"));
  run_with(update, joined(study.metrics, " "), std::string("metrics"));
  SQLite::Statement margin(database, "INSERT OR REPLACE INTO study VALUES ('margin', ?)");
  run_with(margin, exact(study.margin));
  run_with(update, std::to_string(surveys), std::string("surveys"));
  run_with(update, std::to_string(trials), std::string("trials"));
  update_labels(database, study);
  run_with(update, checksum_of(stored_study(database)), std::string("checksum"));
}

StudyDescription read_study(SQLite::Database& database) {
  StudyDescription study = stored_study(database);
  if (study_word(database, "checksum") != checksum_of(study)) {
    throw DamagedStore(
        std::string("is damaged: what it says of the study is not what was stored (its checksum "
                    "differs)") +
        kRemedy);
  }
  require_sound(study);
  return study;
}

}  // namespace fathom
