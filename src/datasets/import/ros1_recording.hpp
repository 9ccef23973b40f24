#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

struct Ros1Connection {
  std::string topic;
  std::string type;
  std::string md5;
};

/// A bag of ROS 1 as librosbag shows it. Throws std::runtime_error.
class Ros1Recording {
 public:
  virtual ~Ros1Recording() = default;

  /// One for each publisher: a topic may have several.
  virtual std::vector<Ros1Connection> connections() const = 0;
  /// What librosbag left out, in its words, with how often.
  virtual std::map<std::string, std::size_t> left_out() const = 0;
  virtual std::size_t messages_of(const std::string& topic) const = 0;

  /// The bytes are valid during the call alone.
  using Take = std::function<void(const std::string& topic, std::int64_t record_time_ns,
                                  std::string_view bytes)>;
  /// In the order of recording. What `take` throws passes.
  virtual void read(const std::set<std::string>& topics, const Take& take) const = 0;
};

/// What the module has: librosbag needs some twenty libraries, Python's among them, so that it is
/// loaded by those alone who read such a bag. The caller owns what it returns.
using OpenRos1Recording = Ros1Recording*(const char* path);
inline constexpr const char* kOpenRos1Recording = "fathom_open_ros1_recording";

}  // namespace fathom
