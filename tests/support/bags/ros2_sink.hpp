#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/bags/bag_writer.hpp"

namespace fathom::test {

/// Where a writer's messages of ROS 2 go; the file is whole once it is destroyed.
class Ros2Sink {
 public:
  virtual ~Ros2Sink() = default;
  virtual void write(const std::string& topic, const std::string& type, std::int64_t record_ns,
                     const std::vector<std::uint8_t>& cdr) = 0;
};

std::unique_ptr<Ros2Sink> sqlite_sink(const std::filesystem::path& path);
std::unique_ptr<Ros2Sink> mcap_sink(const std::filesystem::path& path, const McapLayout& layout);

}  // namespace fathom::test
