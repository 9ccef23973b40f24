#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fathom/results/merge.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/shard.hpp"

namespace fathom {

/// How much of a shard a folder has.
struct ShardProgress {
  ShardPlan plan;
  std::set<RunKey> made = {};  ///< by its sessions
  std::size_t done = 0;        ///< runs of estimators
  std::size_t failed = 0;      ///< of these

  /// Whether a run is its: whichever session made it, and where the plan does not say which trials
  /// are its, of its sessions.
  bool has(const RunKey& run) const;
};

/// What a folder with a store has, without dead reckoning's runs.
struct ShardFolder {
  std::filesystem::path folder;
  StudyDescription study;
  std::set<RunKey> done;
  std::set<RunKey> failed;            ///< of these
  std::size_t of = 0;                 ///< runs of the whole study
  std::vector<ShardProgress> shards;  ///< in order; empty of a study that was not divided since
                                      ///< it had so many surveys and trials
  std::string command_line;           ///< of the last session

  /// Of a study that was not divided, or of which all is there.
  bool is_whole() const;
  /// Runs that are its: of its shards, or of the whole study.
  std::size_t own() const;
  std::size_t own_done() const;
  std::size_t own_failed() const;
};

ShardFolder shard_folder(const std::filesystem::path& folder, const ResultStore& store);

/// By study: folders that `fathom merge` would make one of, in their order.
std::vector<std::vector<ShardFolder>> by_study(std::vector<ShardFolder> folders);

/// Runs of estimators that a study asks for, of whose folders each may know of more surveys or
/// trials.
std::size_t runs_asked(const std::vector<ShardFolder>& folders);

/// What of a study is in none of some folders, which lack so many runs together.
std::vector<MissingPart> missing_parts(const std::vector<ShardFolder>& folders,
                                       std::size_t missing_runs);

}  // namespace fathom
