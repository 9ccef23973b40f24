#pragma once

#include <cstdint>
#include <filesystem>
#include <set>

#include "fathom/datasets/import.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// Writes `folder`/sensor.yaml of the one camera that a COLMAP text model's images are of, mounted
/// as `mounting` is; without `cameras.txt` nothing. Where there is none to write, a note says why.
/// Throws InputError on a file that is no such list.
void write_colmap_camera(const std::filesystem::path& model, const std::set<std::int64_t>& used,
                         const CameraModel& mounting, const std::filesystem::path& folder,
                         ImportReport& report);

}  // namespace fathom
