#pragma once

#include <filesystem>

namespace fathom {

/// Keeps other processes out of a folder as long as it lives; the system lets go of it when a
/// process dies, however it dies.
class FileLock {
 public:
  /// Makes `file` and holds it. Throws InputError where it cannot be made, or where another holder
  /// has it: then with `busy` as the message.
  FileLock(const std::filesystem::path& file, const std::string& busy);
  ~FileLock();

  /// Whether a process of this machine holds `file`.
  static bool is_held(const std::filesystem::path& file);

  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace fathom
