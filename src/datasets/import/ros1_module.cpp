// The one file that includes headers of ROS: a module, loaded at need (ros1_bag.cpp).

#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <stdexcept>

#include "ros1_recording.hpp"

namespace fathom {
namespace {

// What librosbag would print: it leaves out messages recorded at time 0, where the clock of a
// simulation begins, and prints what it throws.
class Printed : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel /*level*/, const char* /*file*/,
           int /*line*/) override {
    ++lines[text];
  }

  std::map<std::string, std::size_t> lines;
};

Printed& printed() {
  static Printed handler;
  return handler;
}

// What librosbag throws becomes a standard error; all else passes.
template <class Action>
auto guarded(const Action& action) {
  try {
    return action();
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(std::string(error.what()) +
                             "; 'rosbag reindex' or 'rosbag check' may help");
  } catch (const ros::Exception& error) {
    throw std::runtime_error(error.what());
  }
}

class Librosbag : public Ros1Recording {
 public:
  explicit Librosbag(const char* path) {
    console_bridge::useOutputHandler(&printed());
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_WARN);
    printed().lines.clear();
    guarded([&] { bag_.open(path, rosbag::bagmode::Read); });
    left_out_ = printed().lines;
  }

  std::map<std::string, std::size_t> left_out() const override { return left_out_; }

  std::vector<Ros1Connection> connections() const override {
    return guarded([this] {
      std::vector<Ros1Connection> found;
      rosbag::View all(bag_);
      for (const rosbag::ConnectionInfo* connection : all.getConnections()) {
        found.push_back({connection->topic, connection->datatype, connection->md5sum});
      }
      return found;
    });
  }

  std::size_t messages_of(const std::string& topic) const override {
    return guarded([&] {
      rosbag::View view(bag_, in({topic}));
      return static_cast<std::size_t>(view.size());
    });
  }

  void read(const std::set<std::string>& topics, const Take& take) const override {
    guarded([&] {
      rosbag::View view(bag_, in(topics));
      std::vector<std::uint8_t> bytes;
      for (const rosbag::MessageInstance& message : view) {
        bytes.resize(message.size());
        ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
        message.write(stream);
        take(message.getTopic(), static_cast<std::int64_t>(message.getTime().toNSec()),
             {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }
    });
  }

 private:
  static std::function<bool(const rosbag::ConnectionInfo*)> in(std::set<std::string> topics) {
    return [topics = std::move(topics)](const rosbag::ConnectionInfo* connection) {
      return topics.contains(connection->topic);
    };
  }

  rosbag::Bag bag_;
  std::map<std::string, std::size_t> left_out_;
};

}  // namespace
}  // namespace fathom

extern "C" [[gnu::visibility("default")]] fathom::Ros1Recording* fathom_open_ros1_recording(
    const char* path) {
  return std::make_unique<fathom::Librosbag>(path).release();
}
