#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

/// Folders of `mav0` that nobody reads and whose names are nearly those of sensors that are read, a
/// line each, by name. Sensors of other kinds (imu0, leica0, a second camera) are none.
std::vector<std::string> unread_folders(const std::filesystem::path& mav0);

/// "; rename NAME to `sensor` if that is what it holds", of such a folder; or nothing.
std::string near_folder_hint(const std::filesystem::path& mav0, const std::string& sensor);

}  // namespace fathom
