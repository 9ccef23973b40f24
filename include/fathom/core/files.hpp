#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fathom {

/// The largest file that is read: one that fits in memory with what is made of it.
inline constexpr std::size_t kMostFileBytes = 2'000'000'000;

/// The file's bytes; throws InputError naming the file if it cannot be read or has more than
/// `most_bytes`, of which no more are read, EnvironmentError where that is the machine's fault.
std::string read_file(const std::filesystem::path& path, std::size_t most_bytes = kMostFileBytes);

/// The same for a text: without the UTF-8 byte order mark that some editors put before it.
std::string read_text(const std::filesystem::path& path, std::size_t most_bytes = kMostFileBytes);

/// Throws InputError where writing `output` would replace or remove what is read: one of `inputs`
/// itself, by whatever path, symbolic or hard link, or a folder that holds one.
void refuse_replacing(const std::filesystem::path& output,
                      const std::vector<std::filesystem::path>& inputs);

/// The file to write for an output that a person named: what a symbolic link leads to, so that the
/// link stays. Throws InputError where it is a device or a pipe.
std::filesystem::path output_file(const std::filesystem::path& path);

/// Writes a whole file or nothing: into a neighbour first, then renamed, so that a symbolic link of
/// the name is replaced. It is on its disk when this returns; below a StagedFolder, when that is
/// committed. Throws EnvironmentError, and InputError where a device or a pipe has the name.
void write_file(const std::filesystem::path& path, std::string_view content);

/// An output folder that appears whole or not at all. Files are written below `path()`; `commit`
/// moves them to the target, replacing entries of the same name and leaving others alone. Without
/// commit nothing of them, nor a folder made for them, is left; what a process of this machine and
/// boot left that was killed is removed by the next one. Of the `inputs` of the program none is
/// replaced: commit refuses it. What the system refuses is an EnvironmentError.
class StagedFolder {
 public:
  explicit StagedFolder(const std::filesystem::path& target,
                        std::vector<std::filesystem::path> inputs = {});
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::filesystem::path& path() const { return staging_; }
  const std::filesystem::path& target() const { return target_; }
  /// `own`: names that this kind of output may have and not always has; older ones are removed. All
  /// is on its disk before any of it has its name.
  void commit(const std::vector<std::string>& own = {});

 private:
  void sync() const;
  void sync_names() const;
  void discard();

  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> inputs_;
  std::filesystem::path first_created_;  ///< topmost folder made for the target, or empty
  bool committed_ = false;
};

}  // namespace fathom
