#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

struct Ros2Topic {
  std::string name;
  std::string type;    ///< "sensor_msgs/msg/Image"
  std::string format;  ///< how its messages are serialised, such as "cdr"
  std::size_t messages = 0;
};

/// One file of a ROS 2 bag, whatever it is stored as. Throws InputError naming the file where it is
/// cut short, damaged or no such file.
class Ros2File {
 public:
  virtual ~Ros2File() = default;

  /// One for each publisher: a topic may have several.
  virtual std::vector<Ros2Topic> topics() const = 0;

  /// The bytes are valid during the call alone.
  using Take = std::function<void(const std::string& topic, std::int64_t record_time_ns,
                                  std::string_view bytes)>;
  /// In the order of recording. What `take` throws passes.
  virtual void read(const std::set<std::string>& topics, const Take& take) const = 0;
};

std::unique_ptr<Ros2File> open_sqlite_file(const std::filesystem::path& path);

/// Reads the file once from end to end; with all checksums that it has.
std::unique_ptr<Ros2File> open_mcap_file(const std::filesystem::path& path);

/// By its first bytes.
bool is_mcap(const std::filesystem::path& path);

}  // namespace fathom
