#pragma once

#include <filesystem>

namespace fathom {

/// Walks the records of a ROS 1 bag by their lengths and those in their headers, also the records
/// of chunks that are not compressed. Throws InputError naming the file where it was not closed,
/// ends inside a record, has a header whose fields do not fill it, or is of another version
/// than 2.0: librosbag takes lengths and offsets on trust.
void check_ros1_records(const std::filesystem::path& path);

}  // namespace fathom
