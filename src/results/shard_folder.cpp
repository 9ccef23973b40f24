#include "fathom/results/shard_folder.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "fathom/results/run_index.hpp"

namespace fathom {
namespace {

// By what tells shards apart: of how many, and which.
using ShardNumber = std::pair<std::size_t, std::size_t>;

ShardNumber number_of(const ShardPlan& plan) {
  return {plan.shard.of, plan.shard.index};
}

std::string count_text(std::size_t done, std::size_t of) {
  return fmt::format("{} of {} runs", of - done, of);
}

// The most that any folder has of each shard.
std::map<ShardNumber, ShardProgress> all_shards(const std::vector<ShardFolder>& folders) {
  std::map<ShardNumber, ShardProgress> all;
  for (const ShardFolder& folder : folders) {
    for (const ShardProgress& shard : folder.shards) {
      const auto [there, is_new] = all.emplace(number_of(shard.plan), shard);
      if (!is_new && shard.done > there->second.done) there->second = shard;
    }
  }
  return all;
}

}  // namespace

std::size_t ShardFolder::own() const {
  if (shards.empty()) return of;
  return std::accumulate(
      shards.begin(), shards.end(), std::size_t{0},
      [](std::size_t sum, const ShardProgress& shard) { return sum + shard.plan.runs; });
}

ShardFolder shard_folder(const std::filesystem::path& folder, const ResultStore& store) {
  const StudyDescription& study = store.study();
  ShardFolder found;
  found.folder = folder;
  found.title = study.title;
  found.of = study.cell_count() * study.surveys * study.trials * study.estimators.size();
  const std::vector<std::string> manifests = store.manifests();
  std::vector<std::optional<ShardNumber>> number_of_session;
  std::map<ShardNumber, ShardProgress> shards;
  for (const std::string& manifest : manifests) {
    const auto plan = shard_plan(manifest);
    number_of_session.push_back(plan ? std::optional(number_of(*plan)) : std::nullopt);
    if (plan) shards[number_of(*plan)].plan = *plan;
  }
  if (!manifests.empty()) found.command_line = command_line_of(manifests.back());
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator == kDeadReckoning) continue;
    found.done.insert(run.key);
    if (is_failed(run)) found.failed.insert(run.key);
    if (run.session >= number_of_session.size() || !number_of_session[run.session]) continue;
    ShardProgress& shard = shards[*number_of_session[run.session]];
    ++shard.done;
    shard.failed += is_failed(run) ? 1 : 0;
  }
  for (auto& [number, shard] : shards) found.shards.push_back(std::move(shard));
  return found;
}

std::vector<MissingPart> missing_parts(const std::vector<ShardFolder>& folders,
                                       std::size_t missing_runs) {
  if (missing_runs == 0) return {};
  std::vector<MissingPart> missing;
  const auto shards = all_shards(folders);
  for (const auto& [number, shard] : shards) {
    if (shard.done >= shard.plan.runs) continue;
    missing.push_back({fmt::format("shard {}: {}", text_of(shard.plan.shard),
                                   count_text(shard.done, shard.plan.runs)),
                       shard.plan.command_line});
  }
  const bool is_one_division =
      !shards.empty() && shards.begin()->first.first == shards.rbegin()->first.first;
  if (is_one_division) {
    const ShardPlan& known = shards.begin()->second.plan;
    for (std::size_t index = 1; index <= known.shard.of; ++index) {
      if (shards.contains({known.shard.of, index})) continue;
      missing.push_back({"shard " + text_of(Shard{index, known.shard.of}) + ": all runs",
                         command_of(known, index)});
    }
  }
  for (const ShardFolder& folder : folders) {
    if (!folder.shards.empty() || folder.done.size() >= folder.of) continue;
    missing.push_back({folder.folder.string() + ": " + count_text(folder.done.size(), folder.of),
                       folder.command_line});
  }
  if (missing.empty()) {
    missing.push_back({std::to_string(missing_runs) + " runs",
                       folders.empty() ? "" : folders.front().command_line});
  }
  return missing;
}

}  // namespace fathom
