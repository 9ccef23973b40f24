#include "fathom/core/files.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <signal.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path, std::size_t most_bytes) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path.string(), "is a folder, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string(), "cannot be opened; does it exist?");
  // Not by the size that the system tells: a device or a pipe has none, and may have no end.
  constexpr std::size_t kFirstPiece = 4096;  // most files are small
  std::string content;
  while (file && content.size() <= most_bytes) {
    const std::size_t size = content.size();
    content.resize(size + std::min(std::max(kFirstPiece, size), most_bytes + 1 - size));
    file.read(content.data() + size, static_cast<std::streamsize>(content.size() - size));
    content.resize(size + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw InputError(path.string(), "cannot be read to its end");
  if (content.size() > most_bytes) {
    throw InputError(path.string(),
                     "is too large; the limit is " + std::to_string(most_bytes) + " bytes");
  }
  return content;
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

void write_file(const fs::path& path, std::string_view content) {
  const fs::path partial = path.string() + ".partial-" + std::to_string(::getpid());
  std::ofstream file(partial, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  std::error_code error;
  if (file) {
    fs::rename(partial, path, error);
    if (!error) return;
  }
  std::error_code ignored;
  fs::remove(partial, ignored);
  throw InputError(path.string(), "cannot be written; is the folder there, writable and not full?");
}

namespace {

const std::string kStagingPrefix = ".partial-";

// What a killed process left in the target.
void remove_abandoned(const fs::path& target) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(target, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kStagingPrefix)) continue;
    const auto pid = parse_integer(name.substr(kStagingPrefix.size()));
    if (!pid || *pid <= 0) continue;
    const bool alive = ::kill(static_cast<pid_t>(*pid), 0) == 0 || errno == EPERM;
    if (!alive) fs::remove_all(entry.path(), error);
  }
}

}  // namespace

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
  staging_ = target_ / (kStagingPrefix + std::to_string(::getpid()));
  fs::create_directories(staging_, error);
  if (error) {
    discard();
    throw InputError(target_.string(), "cannot be made: " + error.message());
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

void StagedFolder::commit(const std::vector<std::string>& own) {
  try {
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
  } catch (const fs::filesystem_error& error) {
    throw InputError(target_.string(), "cannot be written: " + error.code().message());
  }
  committed_ = true;
}

}  // namespace fathom
