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
  std::size_t done = 0;    ///< runs of estimators
  std::size_t failed = 0;  ///< of these
};

/// What a folder with a store has, without dead reckoning's runs.
struct ShardFolder {
  std::filesystem::path folder;
  std::string title;
  std::set<RunKey> done;
  std::set<RunKey> failed;            ///< of these
  std::size_t of = 0;                 ///< runs of the whole study
  std::vector<ShardProgress> shards;  ///< in order; empty of a study that was not divided
  std::string command_line;           ///< of the last session

  /// Runs that are its: of its shards, or of the whole study.
  std::size_t own() const;
};

ShardFolder shard_folder(const std::filesystem::path& folder, const ResultStore& store);

/// What of a study is in none of some folders, which lack so many runs together.
std::vector<MissingPart> missing_parts(const std::vector<ShardFolder>& folders,
                                       std::size_t missing_runs);

}  // namespace fathom
