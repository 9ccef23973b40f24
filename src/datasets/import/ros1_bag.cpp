#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>

#include "bag.hpp"
#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/module.hpp"
#include "ros1_recording.hpp"
#include "ros1_records.hpp"

namespace fathom {
namespace {

OpenRos1Recording* open_recording(const std::filesystem::path& bag) {
  if (!feature("rosbag").is_built) {
    throw InputError(bag.string(), "is a bag of ROS 1; " + refusal_without("rosbag"));
  }
  const LoadedModule module =
      load_module({FATHOM_MODULE_BUILT, FATHOM_MODULE_INSTALLED}, kOpenRos1Recording);
  if (module.symbol == nullptr) {
    throw InputError(bag.string(), fmt::format("is a bag of ROS 1; {}; '{}' builds it again",
                                               module.problem, remedy_for(feature("rosbag"))));
  }
  return reinterpret_cast<OpenRos1Recording*>(module.symbol);
}

class Ros1Bag : public Bag {
 public:
  explicit Ros1Bag(const std::filesystem::path& path) : path_(path.string()) {
    OpenRos1Recording* open = open_recording(path);
    check_ros1_records(path);
    guarded([&] {
      recording_.reset(open(path_.c_str()));
      find_topics();
    });
  }

  const std::vector<BagTopic>& topics() const override { return topics_; }

  std::vector<std::string> notes() const override {
    std::vector<std::string> lines;
    for (const auto& [text, times] : recording_->left_out()) {
      lines.push_back(fmt::format("librosbag leaves out {} {}: {}", times,
                                  times == 1 ? "message" : "messages", text));
    }
    return lines;
  }

  void read(const std::vector<std::size_t>& topics,
            const std::function<void(const BagMessage&)>& take) const override {
    std::set<std::string> names;
    for (const std::size_t topic : topics) names.insert(topics_[topic].name);
    guarded([&] {
      recording_->read(names, [&](const std::string& topic, std::int64_t record_time_ns,
                                  std::string_view bytes) {
        const auto reader = ros1_message(bytes);
        take({indices_.at(topic), record_time_ns, *reader});
      });
    });
  }

 private:
  void find_topics() {
    std::map<std::string, BagTopic> found;
    for (const Ros1Connection& connection : recording_->connections()) {
      BagTopic& topic = found[connection.topic];
      // Two publishers may disagree; neither is read then.
      const bool agrees = topic.type.empty() || topic.type == connection.type;
      topic.type = agrees ? connection.type : "several types";
      topic.md5 = connection.md5;
    }
    for (auto& [name, topic] : found) {
      topic.name = name;
      topic.messages = recording_->messages_of(name);
      indices_[name] = topics_.size();
      topics_.push_back(topic);
    }
  }

  // What librosbag throws becomes one line; ours passes.
  template <class Action>
  void guarded(const Action& action) const {
    try {
      action();
    } catch (const InputError&) {
      throw;
    } catch (const std::runtime_error& error) {
      throw InputError(path_, std::string("cannot be read as a bag: ") + error.what());
    }
  }

  std::string path_;
  std::unique_ptr<Ros1Recording> recording_;
  std::vector<BagTopic> topics_;
  std::map<std::string, std::size_t> indices_;
};

}  // namespace

std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1Bag>(path);
}

}  // namespace fathom
