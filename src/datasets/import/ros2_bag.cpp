#include <SQLiteCpp/SQLiteCpp.h>
#include <map>
#include <set>
#include <string_view>

#include "bag.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "ros2_metadata.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

// ROS 2 says sensor_msgs/msg/Image.
std::string plain_type(std::string type) {
  const std::size_t middle = type.find("/msg/");
  if (middle != std::string::npos) type.erase(middle, 4);
  return type;
}

bool is_zstd(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("\x28\xB5\x2F\xFD"sv);
}

class Ros2Bag : public Bag {
 public:
  explicit Ros2Bag(const fs::path& path) : files_(ros2_files(path)) {
    require_cdr();
    std::map<std::string, BagTopic> found;
    for (const fs::path& file : files_) {
      opened(file, [&](SQLite::Database& bag) { find_topics(file, bag, found); });
    }
    for (const auto& [name, topic] : found) {
      indices_[name] = topics_.size();
      topics_.push_back(topic);
    }
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  void read(const std::vector<std::size_t>& topics,
            const std::function<void(const BagMessage&)>& take) const override {
    const std::set<std::size_t> wanted(topics.begin(), topics.end());
    for (const fs::path& file : files_) {
      opened(file, [&](SQLite::Database& bag) { read_file(file, bag, wanted, take); });
    }
  }

 private:
  static void find_topics(const fs::path& file, SQLite::Database& bag,
                          std::map<std::string, BagTopic>& found) {
    SQLite::Statement rows(bag,
                           "SELECT name, type, serialization_format, (SELECT COUNT(*) FROM "
                           "messages WHERE topic_id = topics.id) FROM topics");
    while (rows.executeStep()) {
      const std::string format = rows.getColumn(2).getString();
      if (format != "cdr") {
        throw InputError(file.string(),
                         "has messages in the format " + in_quotes(format) + "; expected cdr");
      }
      BagTopic& topic = found[rows.getColumn(0).getString()];
      topic.name = rows.getColumn(0).getString();
      const std::string type = plain_type(rows.getColumn(1).getString());
      topic.type = topic.type.empty() || topic.type == type ? type : "several types";
      topic.messages += static_cast<std::size_t>(rows.getColumn(3).getInt64());
    }
  }

  void read_file(const fs::path& file, SQLite::Database& bag, const std::set<std::size_t>& wanted,
                 const std::function<void(const BagMessage&)>& take) const {
    std::map<std::int64_t, std::size_t> topic_of;
    SQLite::Statement topics(bag, "SELECT id, name FROM topics");
    while (topics.executeStep()) {
      const std::size_t topic = indices_.at(topics.getColumn(1).getString());
      if (wanted.contains(topic)) topic_of[topics.getColumn(0).getInt64()] = topic;
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
      if (is_zstd(bytes)) refuse_compressed(file);
      const auto reader = cdr_message(bytes);
      take({topic_of.at(one.getColumn(0).getInt64()), one.getColumn(1).getInt64(), *reader});
    }
  }

  // What SQLite throws becomes one line; ours passes.
  template <class Action>
  static void opened(const fs::path& file, const Action& action) {
    try {
      SQLite::Database bag(file.string(), SQLite::OPEN_READONLY);
      action(bag);
    } catch (const SQLite::Exception& error) {
      throw InputError(
          file.string(),
          std::string("cannot be read as a ROS 2 bag, is it cut short? SQLite says: ") +
              error.what());
    }
  }

  std::vector<fs::path> files_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

std::unique_ptr<Bag> open_ros2_bag(const fs::path& path) {
  return std::make_unique<Ros2Bag>(path);
}

}  // namespace fathom
