// The one file that includes headers of ROS.

#include "bag.hpp"
#include "fathom/core/input_error.hpp"

#ifdef FATHOM_ROSBAG

#include <algorithm>
#include <console_bridge/console.h>
#include <map>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <set>
#include <string_view>

#include "ros1_records.hpp"

namespace fathom {
namespace {

class Ros1Bag : public Bag {
 public:
  explicit Ros1Bag(const std::filesystem::path& path) : path_(path.string()) {
    // It prints what it throws as well.
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_NONE);
    check_ros1_records(path);
    guarded([this] {
      bag_.open(path_, rosbag::bagmode::Read);
      find_topics();
    });
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  void read(const std::vector<std::size_t>& topics,
            const std::function<void(const BagMessage&)>& take) const override {
    std::set<std::string> names;
    for (const std::size_t topic : topics) names.insert(topics_[topic].name);
    guarded([&] {
      rosbag::View view(bag_, [&](const rosbag::ConnectionInfo* connection) {
        return names.contains(connection->topic);
      });
      std::vector<std::uint8_t> bytes;
      for (const rosbag::MessageInstance& message : view) {
        bytes.resize(message.size());
        ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
        message.write(stream);
        const auto reader =
            ros1_message({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        take({indices_.at(message.getTopic()),
              static_cast<std::int64_t>(message.getTime().toNSec()), *reader});
      }
    });
  }

 private:
  void find_topics() {
    std::map<std::string, BagTopic> found;
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
      BagTopic& topic = found[connection->topic];
      // Two publishers may disagree; neither is read then.
      const bool agrees = topic.type.empty() || topic.type == connection->datatype;
      topic.type = agrees ? connection->datatype : "several types";
      topic.md5 = connection->md5sum;
    }
    for (auto& [name, topic] : found) {
      topic.name = name;
      rosbag::View view(bag_, [&name = name](const rosbag::ConnectionInfo* connection) {
        return connection->topic == name;
      });
      topic.messages = view.size();
      indices_[name] = topics_.size();
      topics_.push_back(topic);
    }
  }

  // What librosbag throws becomes one line; ours passes.
  template <class Action>
  void guarded(const Action& action) const {
    try {
      action();
    } catch (const rosbag::BagException& error) {
      throw InputError(path_, std::string("cannot be read as a bag: ") + error.what() +
                                  "; 'rosbag reindex' or 'rosbag check' may help");
    } catch (const ros::Exception& error) {
      throw InputError(path_, std::string("cannot be read as a bag: ") + error.what());
    }
  }

  std::string path_;
  rosbag::Bag bag_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1Bag>(path);
}

}  // namespace fathom

#else

namespace fathom {

std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path) {
  throw InputError(path.string(),
                   "is a bag of ROS 1, and this Fathom was built without librosbag-storage-dev; "
                   "'scripts/setup.sh import' installs it, then build again");
}

}  // namespace fathom

#endif
