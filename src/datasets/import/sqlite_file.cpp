#include <SQLiteCpp/SQLiteCpp.h>
#include <map>

#include "fathom/core/input_error.hpp"
#include "ros2_file.hpp"

namespace fathom {
namespace {

class SqliteFile : public Ros2File {
 public:
  explicit SqliteFile(std::string path) : path_(std::move(path)) {}

  std::vector<Ros2Topic> topics() const override {
    std::vector<Ros2Topic> found;
    opened([&](SQLite::Database& bag) {
      SQLite::Statement rows(bag,
                             "SELECT name, type, serialization_format, (SELECT COUNT(*) FROM "
                             "messages WHERE topic_id = topics.id) FROM topics");
      while (rows.executeStep()) {
        found.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString(),
                         rows.getColumn(2).getString(),
                         static_cast<std::size_t>(rows.getColumn(3).getInt64())});
      }
    });
    return found;
  }

  void read(const std::set<std::string>& topics, const Take& take) const override {
    opened([&](SQLite::Database& bag) { read_messages(bag, topics, take); });
  }

 private:
  static void read_messages(SQLite::Database& bag, const std::set<std::string>& wanted,
                            const Take& take) {
    std::map<std::int64_t, std::string> topic_of;
    SQLite::Statement topics(bag, "SELECT id, name FROM topics");
    while (topics.executeStep()) {
      const std::string name = topics.getColumn(1).getString();
      if (wanted.contains(name)) topic_of[topics.getColumn(0).getInt64()] = name;
    }
    // Sorted without the messages themselves, which SQLite would otherwise hold all at once where
    // the bag has no index by time.
    std::vector<std::int64_t> ids;
    SQLite::Statement order(bag, "SELECT id, topic_id FROM messages ORDER BY timestamp, id");
    while (order.executeStep()) {
      if (topic_of.contains(order.getColumn(1).getInt64())) {
        ids.push_back(order.getColumn(0).getInt64());
      }
    }
    SQLite::Statement one(bag, "SELECT topic_id, timestamp, data FROM messages WHERE id = ?");
    for (const std::int64_t id : ids) {
      one.reset();
      one.bind(1, id);
      if (!one.executeStep()) continue;
      const SQLite::Column data = one.getColumn(2);
      const std::string_view bytes(static_cast<const char*>(data.getBlob()),
                                   static_cast<std::size_t>(data.getBytes()));
      take(topic_of.at(one.getColumn(0).getInt64()), one.getColumn(1).getInt64(), bytes);
    }
  }

  // What SQLite throws becomes one line; ours passes.
  template <class Action>
  void opened(const Action& action) const {
    try {
      SQLite::Database bag(path_, SQLite::OPEN_READONLY);
      action(bag);
    } catch (const SQLite::Exception& error) {
      throw InputError(path_, std::string("cannot be read as a ROS 2 bag, is it cut short? SQLite "
                                          "says: ") +
                                  error.what());
    }
  }

  std::string path_;
};

}  // namespace

std::unique_ptr<Ros2File> open_sqlite_file(const std::filesystem::path& path) {
  return std::make_unique<SqliteFile>(path.string());
}

}  // namespace fathom
