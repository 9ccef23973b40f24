#pragma once

#include <filesystem>
#include <vector>

namespace fathom {

/// The `.db3` files of a ROS 2 bag in their order: those that `metadata.yaml` names, or, where a
/// folder has none, all; of a file, itself. Throws InputError that names the conversion where the
/// bag is stored as MCAP or compressed.
std::vector<std::filesystem::path> ros2_files(const std::filesystem::path& path);

[[noreturn]] void refuse_mcap(const std::filesystem::path& path);
[[noreturn]] void refuse_compressed(const std::filesystem::path& path);

}  // namespace fathom
