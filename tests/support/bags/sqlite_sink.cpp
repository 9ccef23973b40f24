#include <SQLiteCpp/SQLiteCpp.h>
#include <map>

#include "support/bags/ros2_sink.hpp"

namespace fathom::test {
namespace {

class SqliteSink : public Ros2Sink {
 public:
  explicit SqliteSink(const std::filesystem::path& path)
      : bag_(path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
    bag_.exec(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
    bag_.exec(
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp "
        "INTEGER NOT NULL, data BLOB NOT NULL)");
    bag_.exec("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
    bag_.exec("BEGIN");
  }
  ~SqliteSink() override { bag_.exec("COMMIT"); }

  void write(const std::string& topic, const std::string& type, std::int64_t record_ns,
             const std::vector<std::uint8_t>& cdr) override {
    const auto [entry, is_new] = topics_.emplace(topic, topics_.size() + 1);
    if (is_new) {
      SQLite::Statement row(bag_, "INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')");
      row.bind(1, static_cast<std::int64_t>(entry->second));
      row.bind(2, topic);
      row.bind(3, type);
      row.exec();
    }
    SQLite::Statement row(bag_, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)");
    row.bind(1, static_cast<std::int64_t>(entry->second));
    row.bind(2, record_ns);
    row.bind(3, cdr.data(), static_cast<int>(cdr.size()));
    row.exec();
  }

 private:
  SQLite::Database bag_;
  std::map<std::string, std::size_t> topics_;
};

}  // namespace

std::unique_ptr<Ros2Sink> sqlite_sink(const std::filesystem::path& path) {
  return std::make_unique<SqliteSink>(path);
}

}  // namespace fathom::test
