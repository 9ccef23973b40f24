#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>

#include "fathom/core/folder_claim.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// The store of a study while it runs, on a disk of this machine: a copy is published in the folder
/// for all to see, now and then and at the end, so that no database is ever open on a file system
/// that machines share. Goes on from what was published, or from what a killed process left on this
/// disk, whichever has more runs.
class ScratchStore {
 public:
  /// Claims `folder` (FolderClaim) and opens the store in a folder of its own below `scratch`, made
  /// if need be. Throws InputError as ResultStore::write does.
  ScratchStore(const std::filesystem::path& folder, const std::filesystem::path& scratch,
               const StudyDescription& study, const std::string& manifest, ClaimTimes times = {});
  /// Publishes what is not yet, and removes what is on this disk where that could be done.
  ~ScratchStore();
  ScratchStore(const ScratchStore&) = delete;
  ScratchStore& operator=(const ScratchStore&) = delete;

  ResultStore& store() { return *store_; }

  /// Puts a copy of the store as it is into the folder, whole or not at all. Throws InputError
  /// where that cannot be done or the folder is another process's by now.
  void publish();
  /// The same, where the last time is long ago: a minute, or twenty times as long as that took.
  void publish_when_due();

 private:
  void open(const StudyDescription& study, const std::string& manifest);

  using Clock = std::chrono::steady_clock;

  std::filesystem::path folder_;
  FolderClaim claim_;
  std::filesystem::path scratch_;
  std::optional<ResultStore> store_;
  Clock::time_point published_ = Clock::now();
  Clock::duration took_{};
};

}  // namespace fathom
