#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fathom/results/shard.hpp"

namespace fathom {

/// What is missing of a study, with the command that does it; empty where it is not known.
struct MissingPart {
  std::string what;  ///< "shard 3/7: all runs"
  std::string command;
};

/// What a merge made.
struct MergeSummary {
  std::size_t sources = 0;
  std::size_t runs = 0;      ///< of estimators, now in the store
  std::size_t of = 0;        ///< of estimators, that the study asks for
  std::size_t repeated = 0;  ///< runs that several sources had, alike but for cost
  std::size_t machines = 0;  ///< kinds of processor that runs were made on
  std::vector<MissingPart> missing;

  bool is_complete() const { return runs == of; }
};

/// Makes one store of those of several folders, and of that of `out` where there is one: the same
/// content as of an undivided study, whatever the order of the folders, cost apart. Of a run that
/// several have one is kept, chosen by what stands in it alone. The store appears in `out` whole or
/// not at all; sources stay as they are. Throws InputError that names the folder: where one has no
/// store or a damaged one, where configuration, version or data differ (with what differs), and
/// where two have another result for one run.
MergeSummary merge_stores(const std::vector<std::filesystem::path>& folders,
                          const std::filesystem::path& out);

}  // namespace fathom
