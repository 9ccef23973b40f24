#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace fathom {

/// What FrameSource::picture_id says of pictures that are files: a hash of the file, read when it
/// is asked for first. Threads may ask at once.
class FileIds {
 public:
  FileIds() = default;
  explicit FileIds(std::size_t count) : ids_(count) {}

  /// Of file i, which is always the same `file`. Throws InputError where it cannot be read, and
  /// reads it again the next time.
  std::uint64_t of(std::size_t i, const std::filesystem::path& file) const;

 private:
  // 0: not known. Two threads may read a file at once; what the first one found stays.
  mutable std::vector<std::atomic<std::uint64_t>> ids_;
};

}  // namespace fathom
