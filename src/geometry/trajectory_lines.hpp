#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

/// Throws the InputError of one line.
class LineOfFile {
 public:
  LineOfFile(const std::string& name, std::size_t number, std::string_view text)
      : name_(&name), number_(number), text_(text) {}

  const std::string& file() const { return *name_; }
  std::size_t number() const { return number_; }
  std::string_view text() const { return text_; }
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  const std::string* name_;
  std::size_t number_;
  std::string_view text_;
};

/// The lines of a text that hold more than blanks and a comment, without the comment.
std::vector<LineOfFile> trajectory_lines(std::string_view content, const std::string& name);

/// Whether commas part the values of a line. Throws InputError where they are decimal commas.
bool has_commas(const LineOfFile& line);

/// Each reads one line, and throws InputError where it is none of its format.
StampedSpatialPose tum_pose(const LineOfFile& line, bool has_commas);
StampedSpatialPose euroc_pose(const LineOfFile& line);
SpatialPose kitti_pose(const LineOfFile& line);
/// Decimal seconds, in nanoseconds.
std::int64_t time_of(const LineOfFile& line, std::string_view seconds);

}  // namespace fathom
