#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "message_reader.hpp"

namespace fathom {

struct BagTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/Image", in both generations of ROS
  std::string md5;   ///< of the type's definition; empty where the bag does not say
  std::size_t messages = 0;
};

struct BagMessage {
  std::size_t topic = 0;            ///< its index among the topics
  std::int64_t record_time_ns = 0;  ///< when it was written to the bag
  MessageReader& reader;
};

/// A recording of either generation of ROS. Throws InputError naming the file where it is cut short
/// or no such recording.
class Bag {
 public:
  virtual ~Bag() = default;

  /// By name.
  virtual const std::vector<BagTopic>& topics() const = 0;

  /// What cannot be read of it.
  virtual std::vector<std::string> notes() const { return {}; }

  /// Hands over the messages of some topics in the order of recording, one at a time; they are
  /// valid during the call alone.
  virtual void read(const std::vector<std::size_t>& topics,
                    const std::function<void(const BagMessage&)>& take) const = 0;
};

/// A `.bag`.
std::unique_ptr<Bag> open_ros1_bag(const std::filesystem::path& path);

/// A `.db3` or `.mcap`, or a folder of them with `metadata.yaml`.
std::unique_ptr<Bag> open_ros2_bag(const std::filesystem::path& path);

}  // namespace fathom
