#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

/// The `.db3` or `.mcap` files of a ROS 2 bag in their order: those that `metadata.yaml` names, or,
/// where a folder has none, all; of a file, itself. Throws InputError that names the conversion
/// where the bag is compressed as a whole.
std::vector<std::filesystem::path> ros2_files(const std::filesystem::path& path);

/// Throws InputError that says `what` of the file or folder, and the conversion.
[[noreturn]] void refuse_compressed(const std::filesystem::path& path,
                                    const std::string& what = "is a compressed ROS 2 bag");

}  // namespace fathom
