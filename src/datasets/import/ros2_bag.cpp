#include <map>
#include <set>
#include <string_view>

#include "bag.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "ros2_file.hpp"
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
  explicit Ros2Bag(const fs::path& path) {
    require_cdr();
    std::map<std::string, BagTopic> found;
    for (const fs::path& file : ros2_files(path)) {
      files_.push_back({file, is_mcap(file) ? open_mcap_file(file) : open_sqlite_file(file)});
      find_topics(files_.back(), found);
    }
    for (const auto& [name, topic] : found) {
      indices_[name] = topics_.size();
      topics_.push_back(topic);
    }
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  void read(const std::vector<std::size_t>& topics,
            const std::function<void(const BagMessage&)>& take) const override {
    std::set<std::string> names;
    for (const std::size_t topic : topics) names.insert(topics_[topic].name);
    for (const File& file : files_) {
      file.content->read(names, [&](const std::string& topic, std::int64_t record_time_ns,
                                    std::string_view bytes) {
        if (is_zstd(bytes)) refuse_compressed(file.path);
        const auto reader = cdr_message(bytes);
        take({indices_.at(topic), record_time_ns, *reader});
      });
    }
  }

 private:
  struct File {
    fs::path path;
    std::unique_ptr<Ros2File> content;
  };

  static void find_topics(const File& file, std::map<std::string, BagTopic>& found) {
    for (const Ros2Topic& one : file.content->topics()) {
      if (one.format != "cdr") {
        throw InputError(file.path.string(),
                         "has messages in the format " + in_quotes(one.format) + "; expected cdr");
      }
      BagTopic& topic = found[one.name];
      topic.name = one.name;
      const std::string type = plain_type(one.type);
      topic.type = topic.type.empty() || topic.type == type ? type : "several types";
      topic.messages += one.messages;
    }
  }

  std::vector<File> files_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

std::unique_ptr<Bag> open_ros2_bag(const fs::path& path) {
  return std::make_unique<Ros2Bag>(path);
}

}  // namespace fathom
