#include "result_schema.hpp"

#include <algorithm>

namespace fathom {
namespace {

// docs/formats.md says what each column means.
constexpr const char* kSchema = R"sql(
CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE configuration (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE data_file (file TEXT PRIMARY KEY, hash TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE axis (axis INTEGER PRIMARY KEY, name TEXT NOT NULL, key TEXT NOT NULL);
CREATE TABLE axis_value (axis INTEGER NOT NULL REFERENCES axis, place INTEGER NOT NULL,
                         label TEXT NOT NULL, PRIMARY KEY (axis, place)) WITHOUT ROWID;
CREATE TABLE cell (cell INTEGER PRIMARY KEY, label TEXT NOT NULL, association TEXT NOT NULL);
CREATE TABLE cell_value (cell INTEGER NOT NULL REFERENCES cell,
                         axis INTEGER NOT NULL REFERENCES axis,
                         place INTEGER NOT NULL, PRIMARY KEY (cell, axis)) WITHOUT ROWID;
CREATE TABLE estimator (estimator INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE,
                        type TEXT NOT NULL);
CREATE TABLE metric (metric INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE,
                     is_cost INTEGER NOT NULL);
CREATE TABLE session (session INTEGER PRIMARY KEY, manifest TEXT NOT NULL);
CREATE TABLE run (run INTEGER PRIMARY KEY, cell INTEGER NOT NULL REFERENCES cell,
                  trial INTEGER NOT NULL, estimator INTEGER NOT NULL REFERENCES estimator,
                  outcome TEXT NOT NULL, fault TEXT NOT NULL, log_hash TEXT NOT NULL,
                  jobs INTEGER NOT NULL,
                  session INTEGER NOT NULL REFERENCES session,
                  UNIQUE (cell, trial, estimator));
CREATE TABLE value (run INTEGER NOT NULL REFERENCES run, metric INTEGER NOT NULL REFERENCES metric,
                    value REAL NOT NULL, PRIMARY KEY (run, metric)) WITHOUT ROWID;
CREATE TABLE series (run INTEGER NOT NULL REFERENCES run, name TEXT NOT NULL,
                     data BLOB NOT NULL, PRIMARY KEY (run, name)) WITHOUT ROWID;
CREATE VIEW result AS
  SELECT cell.label AS cell, cell.association AS association, run.trial AS trial,
         estimator.name AS estimator, run.outcome AS outcome, metric.name AS metric,
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

void insert_cells(SQLite::Database& database, const StudyDescription& study) {
  SQLite::Statement axis(database, "INSERT INTO axis VALUES (?, ?, ?)");
  SQLite::Statement axis_value(database, "INSERT INTO axis_value VALUES (?, ?, ?)");
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    run_with(axis, number(a), study.axes[a].name, study.axes[a].key);
    for (std::size_t place = 0; place < study.axes[a].labels.size(); ++place) {
      run_with(axis_value, number(a), number(place), study.axes[a].labels[place]);
    }
  }
  SQLite::Statement cell(database, "INSERT INTO cell VALUES (?, ?, ?)");
  SQLite::Statement cell_value(database, "INSERT INTO cell_value VALUES (?, ?, ?)");
  for (std::size_t c = 0; c < study.cell_count(); ++c) {
    run_with(cell, number(c), study.label_of(c), study.association_of(c));
    const std::vector<std::size_t> places = study.places_of(c);
    for (std::size_t a = 0; a < places.size(); ++a) {
      run_with(cell_value, number(c), number(a), number(places[a]));
    }
  }
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

Words read_words(SQLite::Database& database, const char* query) {
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

}  // namespace

void write_labels(SQLite::Database& database, const StudyDescription& study) {
  SQLite::Statement axis(database, "UPDATE axis SET name = ? WHERE axis = ?");
  SQLite::Statement label(database, "UPDATE axis_value SET label = ? WHERE axis = ? AND place = ?");
  for (std::size_t a = 0; a < study.axes.size(); ++a) {
    run_with(axis, study.axes[a].name, number(a));
    for (std::size_t place = 0; place < study.axes[a].labels.size(); ++place) {
      run_with(label, study.axes[a].labels[place], number(a), number(place));
    }
  }
  SQLite::Statement cell(database, "UPDATE cell SET label = ? WHERE cell = ?");
  for (std::size_t c = 0; c < study.cell_count(); ++c) {
    run_with(cell, study.label_of(c), number(c));
  }
}

std::string words_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

void create_schema(SQLite::Database& database, const StudyDescription& study) {
  database.exec(kSchema);
  insert_words(database, "study",
               {{"title", study.title},
                {"alignment", study.alignment},
                {"metrics", words_text(study.metrics)},
                {"trials", std::to_string(study.trials)}});
  insert_words(database, "configuration", study.configuration);
  insert_words(database, "data_file", study.data);
  insert_cells(database, study);
  SQLite::Statement estimator(database, "INSERT INTO estimator VALUES (?, ?, ?)");
  run_with(estimator, 0, std::string(kDeadReckoning), std::string());
  for (std::size_t e = 0; e < study.estimators.size(); ++e) {
    run_with(estimator, number(e + 1), study.estimators[e].name, study.estimators[e].type);
  }
  database.exec("PRAGMA application_id = " + std::to_string(kResultApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kResultSchemaVersion));
}

StudyDescription read_study(SQLite::Database& database) {
  StudyDescription study;
  study.title = study_word(database, "title");
  study.alignment = study_word(database, "alignment");
  study.metrics = words_of(study_word(database, "metrics"));
  study.trials = static_cast<std::size_t>(std::stoull("0" + study_word(database, "trials")));
  SQLite::Statement axes(database, "SELECT name, key FROM axis ORDER BY axis");
  while (axes.executeStep()) {
    study.axes.push_back({axes.getColumn(0).getString(), axes.getColumn(1).getString(), {}});
  }
  SQLite::Statement labels(database, "SELECT axis, label FROM axis_value ORDER BY axis, place");
  while (labels.executeStep()) {
    study.axes.at(labels.getColumn(0).getUInt()).labels.push_back(labels.getColumn(1).getString());
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

std::string data_difference(const StudyDescription& there, const StudyDescription& here) {
  const std::map<std::string, std::string> old(there.data.begin(), there.data.end());
  const std::map<std::string, std::string> now(here.data.begin(), here.data.end());
  std::vector<std::string> changes;
  for (const auto& [file, hash] : now) {
    const auto found = old.find(file);
    if (found == old.end()) changes.push_back(file + " is new");
    if (found != old.end() && found->second != hash) changes.push_back(file + " has changed");
  }
  for (const auto& [file, hash] : old) {
    if (!now.contains(file)) changes.push_back(file + " is gone");
  }
  constexpr std::size_t kShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(changes.size(), kShown); ++i) {
    text += (i > 0 ? "; " : "") + changes[i];
  }
  if (changes.size() > kShown) text += "; and " + std::to_string(changes.size() - kShown) + " more";
  return text;
}

std::string difference(const StudyDescription& there, const StudyDescription& here) {
  const std::map<std::string, std::string> old(there.configuration.begin(),
                                               there.configuration.end());
  const std::map<std::string, std::string> now(here.configuration.begin(),
                                               here.configuration.end());
  std::string text;
  const auto say = [&text](const std::string& key, const std::string& was, const std::string& is) {
    if (!text.empty()) text += "; ";
    text.append(key).append(": ").append(was).append(" there, ").append(is).append(" here");
  };
  for (const auto& [key, value] : now) {
    const auto found = old.find(key);
    if (found == old.end()) {
      say(key, "absent", value);
    } else if (found->second != value) {
      say(key, found->second, value);
    }
  }
  for (const auto& [key, value] : old) {
    if (!now.contains(key)) say(key, value, "absent");
  }
  return text;
}

}  // namespace fathom
