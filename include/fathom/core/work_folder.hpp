#pragma once

#include <filesystem>
#include <string>

namespace fathom {

/// The folder for temporary files: $TMPDIR, or /tmp. Throws EnvironmentError, which names TMPDIR,
/// where it is none.
std::filesystem::path temporary_place();

/// A new, empty folder in temporary_place(), there as long as this is. Those of the same name that
/// dead processes of this machine left are removed.
class WorkFolder {
 public:
  /// Its name begins with `name`. Throws EnvironmentError where it cannot be made.
  explicit WorkFolder(const std::string& name);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace fathom
