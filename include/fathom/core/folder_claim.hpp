#pragma once

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace fathom {

/// How often a claim says that it lives, and how long one must have been silent to be taken over.
/// Both are measured by each machine's own steady clock: what time it is plays no part.
struct ClaimTimes {
  std::chrono::milliseconds beat{2'000};
  std::chrono::milliseconds patience{15'000};
};

/// Who holds a folder, as its claim says.
struct ClaimHolder {
  std::string host;
  long process = 0;
  bool is_alive = false;
};

/// Keeps other machines out of a folder on a file system that they share, as long as it lives: the
/// file `results.owner`, rewritten every beat. A lock of the system (`FileLock`) does not always
/// reach over machines. The claim of a process of this machine that is dead is taken over at once,
/// any other once its file has not changed for `patience`.
class FolderClaim {
 public:
  /// Throws InputError where another process holds the folder, or where it cannot be written.
  explicit FolderClaim(const std::filesystem::path& folder, ClaimTimes times = {});
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

  /// Whether the folder is still this process's. One that slept beyond the patience of another may
  /// have lost it; it must then write nothing more there. Throws InputError where it is not.
  void require_held() const;

  /// Who holds a folder; nobody: an empty host. Looks for as long as a beat and a half to
  /// see whether it lives.
  static ClaimHolder holder_of(const std::filesystem::path& folder, ClaimTimes times = {});

  /// For one that keeps others out in another way. Throws InputError where somebody who lives holds
  /// the folder.
  static void require_free(const std::filesystem::path& folder, ClaimTimes times = {});

 private:
  void beat();
  void write(const std::string& text) const;

  std::filesystem::path file_;
  ClaimTimes times_;
  std::string token_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_ended_ = false;
  std::thread thread_;
};

}  // namespace fathom
