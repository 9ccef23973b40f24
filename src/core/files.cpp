#include "fathom/core/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/system.hpp"
#include "partial_files.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

// Of a name that is not final yet; the mark of its process follows.
constexpr std::string_view kPartial = ".partial-";

// A file of the system's; nothing where it could not be opened.
class OpenFile {
 public:
  OpenFile(const fs::path& path, int flags)
      : descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~OpenFile() { close(); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  /// Some file systems say only now that there was no room. The errno stays.
  bool close() {
    const int error = errno;
    const bool is_closed = descriptor_ < 0 || ::close(std::exchange(descriptor_, -1)) == 0;
    if (is_closed) errno = error;
    return is_closed;
  }

 private:
  int descriptor_;
};

// False with the errno of what failed.
bool put(const fs::path& path, std::string_view content, bool is_awaited_on_disk) {
  OpenFile file(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.is_open()) return false;
  while (!content.empty()) {
    const ssize_t count = ::write(file.descriptor(), content.data(), content.size());
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) content.remove_prefix(static_cast<std::size_t>(count));
  }
  if (is_awaited_on_disk && ::fsync(file.descriptor()) != 0) return false;
  return file.close();
}

// Whoever commits the folder waits for the disk, once for all files.
bool is_staged(const fs::path& path) {
  return std::any_of(path.begin(), path.end(),
                     [](const fs::path& name) { return name.string().starts_with(kPartial); });
}

// A folder is refused by the system.
void refuse_device(const fs::path& path, const fs::file_status& there) {
  if (!fs::is_other(there)) return;
  throw InputError(path.string(), "is a device or a pipe, not a file");
}

}  // namespace

std::string read_file(const fs::path& path, std::size_t most_bytes) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path.string(), "is a folder, not a file");
  const OpenFile file(path, O_RDONLY);
  if (!file.is_open()) {
    if (is_fault_of_environment(errno)) {
      throw EnvironmentError(path.string(), "cannot be opened", errno);
    }
    throw InputError(path.string(), "cannot be opened; does it exist?");
  }
  constexpr std::size_t kFirstPiece = 4096;  // most files are small
  std::string content;
  // A device or a pipe has no size that the system tells, and may have no end.
  const std::uintmax_t told = fs::file_size(path, error);
  const bool is_too_large = !error && told > most_bytes;
  while (!is_too_large && content.size() <= most_bytes) {
    const std::size_t size = content.size();
    content.resize(size + std::min(std::max(kFirstPiece, size), most_bytes + 1 - size));
    const ssize_t got = ::read(file.descriptor(), content.data() + size, content.size() - size);
    const int fault = errno;
    content.resize(size + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return content;
    if (got < 0 && fault != EINTR) {
      throw EnvironmentError(path.string(), "cannot be read to its end", fault);
    }
  }
  throw InputError(path.string(),
                   "is too large; the limit is " + std::to_string(most_bytes) + " bytes");
}

std::string read_text(const fs::path& path, std::size_t most_bytes) {
  std::string content = read_file(path, most_bytes);
  if (content.starts_with("\xEF\xBB\xBF")) content.erase(0, 3);
  return content;
}

void refuse_replacing(const fs::path& output, const std::vector<fs::path>& inputs) {
  std::error_code error;
  if (!fs::exists(output, error)) return;
  for (const fs::path& input : inputs) {
    if (input.empty()) continue;
    for (fs::path held = fs::canonical(input, error); !error && held.has_relative_path();
         held = held.parent_path()) {
      if (fs::equivalent(held, output, error)) {
        throw InputError(output.string(), "would replace " + input.string() +
                                              ", which is read; --out takes another place");
      }
    }
  }
}

fs::path output_file(const fs::path& path) {
  std::error_code error;
  refuse_device(path, fs::status(path, error));
  return fs::is_symlink(fs::symlink_status(path, error)) ? fs::weakly_canonical(path) : path;
}

void write_file(const fs::path& path, std::string_view content) {
  std::error_code error;
  refuse_device(path, fs::symlink_status(path, error));
  const fs::path partial = path.string() + std::string(kPartial) + process_mark();
  const bool is_awaited = !is_staged(path);
  if (!put(partial, content, is_awaited) || ::rename(partial.c_str(), path.c_str()) != 0) {
    const int fault = errno;
    ::unlink(partial.c_str());
    throw EnvironmentError(path.string(), "cannot be written", fault);
  }
  if (is_awaited) sync_to_disk(path.has_parent_path() ? path.parent_path() : ".");
}

void remove_abandoned(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const std::size_t at = name.rfind(kPartial);
    if (at == std::string::npos || !is_mark_of_dead(name.substr(at + kPartial.size()))) continue;
    fs::remove_all(entry.path(), error);
  }
}

StagedFolder::StagedFolder(const fs::path& target, std::vector<fs::path> inputs)
    : target_(fs::absolute(target).lexically_normal()), inputs_(std::move(inputs)) {
  if (!target_.has_filename()) target_ = target_.parent_path();  // a trailing slash
  std::error_code error;
  if (fs::exists(target_, error) && !fs::is_directory(target_, error)) {
    throw InputError(target_.string(), "is a file; --out takes a folder");
  }
  for (fs::path folder = target_; !folder.empty() && !fs::exists(folder, error);
       folder = folder.parent_path()) {
    first_created_ = folder;
  }
  remove_abandoned(target_);
  staging_ = target_ / (std::string(kPartial) + process_mark());
  fs::create_directories(staging_, error);
  if (error) {
    discard();
    throw EnvironmentError(target_.string(), "cannot be made: " + error.message());
  }
}

// Of the folders made for the target only those that are empty: another process may use them too.
void StagedFolder::discard() {
  std::error_code error;
  fs::remove_all(staging_, error);
  if (first_created_.empty()) return;
  for (fs::path folder = target_; fs::remove(folder, error) && folder != first_created_;) {
    folder = folder.parent_path();
  }
}

StagedFolder::~StagedFolder() {
  if (!committed_) discard();
}

// All that is in the folder, and the folder.
void StagedFolder::sync() const {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(staging_)) {
    if (!entry.is_symlink()) sync_to_disk(entry.path());
  }
  sync_to_disk(staging_);
}

// The names in the target, and that of every folder that was made for it.
void StagedFolder::sync_names() const {
  const fs::path top = first_created_.empty() ? target_ : first_created_.parent_path();
  for (fs::path folder = target_; sync_to_disk(folder), folder != top;) {
    folder = folder.parent_path();
  }
}

void StagedFolder::commit(const std::vector<std::string>& own) {
  try {
    const bool is_inner = is_staged(target_);  // the outer one waits for the disk
    if (!is_inner) sync();
    for (const std::string& name : own) refuse_replacing(target_ / name, inputs_);
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
      refuse_replacing(target_ / entry.path().filename(), inputs_);
    }
    for (const std::string& name : own) fs::remove_all(target_ / name);
    for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
      const fs::path destination = target_ / entry.path().filename();
      // A file is replaced in one step: killed in between, one of the two is there.
      const bool is_folder = fs::is_directory(fs::symlink_status(destination));
      if (is_folder || entry.is_directory()) fs::remove_all(destination);
      fs::rename(entry.path(), destination);
    }
    fs::remove(staging_);
    if (!is_inner) sync_names();
  } catch (const fs::filesystem_error& error) {
    throw EnvironmentError(target_.string(), "cannot be written: " + error.code().message());
  }
  committed_ = true;
}

}  // namespace fathom
