#pragma once

#include <filesystem>

namespace fathom {

/// Keeps other processes out of a folder as long as it lives; the system lets go of it when a
/// process dies, however it dies.
class FileLock {
 public:
  /// Makes `file` and holds it. Throws EnvironmentError where it cannot be made, InputError with
  /// `busy` as the message where another holder has it.
  FileLock(const std::filesystem::path& file, const std::string& busy);
  ~FileLock();

  /// Whether a process of this machine holds `file`.
  static bool is_held(const std::filesystem::path& file);

  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  /// Whether what is held is what others find under the name.
  bool is_at_its_place() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace fathom
