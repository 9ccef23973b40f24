#include "fathom/results/shard_folder.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <set>

#include "fathom/core/text.hpp"
#include "fathom/results/run_index.hpp"
#include "result_schema.hpp"

namespace fathom {
namespace {

// By what tells shards apart: of how many, and which.
using ShardNumber = std::pair<std::size_t, std::size_t>;

ShardNumber number_of(const ShardPlan& plan) {
  return {plan.shard.of, plan.shard.index};
}

// How far a study is asked for, which sessions extend.
struct Extent {
  std::size_t surveys = 0;
  std::size_t trials = 0;
  bool operator==(const Extent&) const = default;
};

Extent extent_of(const ShardFolder& folder) {
  return {folder.study.surveys, folder.study.trials};
}

// Whether a shard is of a study as far as it is asked for now: where that is extended, its shards
// are cut anew. A plan that does not say its trials is taken for one.
bool is_of(const ShardPlan& plan, const ShardFolder& folder) {
  return plan.range.places.empty() ||
         Extent{plan.range.surveys, plan.range.trials} == extent_of(folder);
}

Extent extent_of(const std::vector<ShardFolder>& folders) {
  Extent most;
  for (const ShardFolder& folder : folders) {
    most.surveys = std::max(most.surveys, folder.study.surveys);
    most.trials = std::max(most.trials, folder.study.trials);
  }
  return most;
}

std::string count_text(std::size_t done, std::size_t of) {
  return fmt::format("{} of {} runs", of - std::min(done, of), of);
}

template <class Count>
std::size_t sum_of(const std::vector<ShardProgress>& shards, const Count& count) {
  return std::accumulate(
      shards.begin(), shards.end(), std::size_t{0},
      [&](std::size_t sum, const ShardProgress& shard) { return sum + count(shard); });
}

// The shards of a study as far as it is asked for, with what all folders together have of each.
struct AllShards {
  std::map<ShardNumber, ShardProgress> known;
  std::size_t others_done = 0;  // runs of shards that no folder knows of
};

AllShards all_shards(const std::vector<ShardFolder>& folders) {
  const Extent extent = extent_of(folders);
  AllShards all;
  std::set<RunKey> done;
  for (const ShardFolder& folder : folders) {
    done.insert(folder.done.begin(), folder.done.end());
    if (extent_of(folder) != extent) continue;
    for (const ShardProgress& shard : folder.shards) {
      ShardProgress& known =
          all.known.try_emplace(number_of(shard.plan), ShardProgress{shard.plan}).first->second;
      known.made.insert(shard.made.begin(), shard.made.end());
    }
  }
  for (const RunKey& run : done) {
    bool is_known = false;
    for (auto& [number, shard] : all.known) {
      if (!shard.has(run)) continue;
      ++shard.done;
      is_known = true;
    }
    if (!is_known) ++all.others_done;
  }
  return all;
}

// Of shards of one division, those that no folder knows of, too.
std::vector<MissingPart> missing_shards(const AllShards& all) {
  std::vector<MissingPart> missing;
  for (const auto& [number, shard] : all.known) {
    if (shard.done >= shard.plan.runs) continue;
    missing.push_back({fmt::format("shard {}: {}", text_of(shard.plan.shard),
                                   count_text(shard.done, shard.plan.runs)),
                       shard.plan.command_line});
  }
  const std::string what = all.others_done == 0 ? ": all runs" : ": what is missing of it";
  const ShardPlan& known = all.known.begin()->second.plan;
  for (std::size_t index = 1; index <= known.shard.of; ++index) {
    if (all.known.contains({known.shard.of, index})) continue;
    missing.push_back(
        {"shard " + text_of(Shard{index, known.shard.of}) + what, command_of(known, index)});
  }
  return missing;
}

std::vector<MissingPart> missing_of_undivided(const std::vector<ShardFolder>& folders) {
  std::vector<MissingPart> missing;
  for (const ShardFolder& folder : folders) {
    const bool is_current = extent_of(folder) == extent_of(folders);
    if (!is_current || !folder.shards.empty() || folder.done.size() >= folder.of) continue;
    missing.push_back({folder.folder.string() + ": " + count_text(folder.done.size(), folder.of),
                       folder.command_line});
  }
  return missing;
}

}  // namespace

bool ShardProgress::has(const RunKey& run) const {
  return plan.range.places.empty() ? made.contains(run) : plan.range.has(run);
}

bool ShardFolder::is_whole() const {
  return shards.empty() || done.size() == of;
}

std::size_t ShardFolder::own() const {
  return is_whole() ? of : sum_of(shards, [](const ShardProgress& one) { return one.plan.runs; });
}

std::size_t ShardFolder::own_done() const {
  return is_whole() ? done.size()
                    : sum_of(shards, [](const ShardProgress& one) { return one.done; });
}

std::size_t ShardFolder::own_failed() const {
  return is_whole() ? failed.size()
                    : sum_of(shards, [](const ShardProgress& one) { return one.failed; });
}

ShardFolder shard_folder(const std::filesystem::path& folder, const ResultStore& store) {
  ShardFolder found;
  found.folder = folder;
  found.study = store.study();
  found.of = runs_asked({found});
  const std::vector<std::string> manifests = store.manifests();
  std::map<ShardNumber, ShardProgress> shards;
  std::vector<ShardProgress*> of_session;
  for (const std::string& manifest : manifests) {
    const auto plan = shard_plan(manifest);
    of_session.push_back(plan && is_of(*plan, found) ? &shards[number_of(*plan)] : nullptr);
    if (of_session.back() != nullptr) of_session.back()->plan = *plan;
  }
  if (!manifests.empty()) found.command_line = command_line_of(manifests.back());
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator == kDeadReckoning) continue;
    found.done.insert(run.key);
    if (is_failed(run)) found.failed.insert(run.key);
    const bool is_of_shard = run.session < of_session.size() && of_session[run.session] != nullptr;
    if (is_of_shard) of_session[run.session]->made.insert(run.key);
    for (auto& [number, shard] : shards) {
      if (!shard.has(run.key)) continue;
      ++shard.done;
      shard.failed += is_failed(run) ? 1 : 0;
    }
  }
  for (auto& [number, shard] : shards) found.shards.push_back(std::move(shard));
  return found;
}

std::vector<std::vector<ShardFolder>> by_study(std::vector<ShardFolder> folders) {
  std::vector<std::vector<ShardFolder>> studies;
  for (ShardFolder& folder : folders) {
    const auto study = std::ranges::find_if(studies, [&folder](const auto& others) {
      const StudyDescription& there = others.front().study;
      return difference(there, folder.study).empty() &&
             data_difference(there, folder.study).empty();
    });
    if (study == studies.end()) {
      studies.emplace_back();
      studies.back().push_back(std::move(folder));
    } else {
      study->push_back(std::move(folder));
    }
  }
  return studies;
}

std::size_t runs_asked(const std::vector<ShardFolder>& folders) {
  if (folders.empty()) return 0;
  const Extent extent = extent_of(folders);
  const StudyDescription& study = folders.front().study;
  return study.cell_count() * extent.surveys * extent.trials * study.estimators.size();
}

std::vector<MissingPart> missing_parts(const std::vector<ShardFolder>& folders,
                                       std::size_t missing_runs) {
  if (missing_runs == 0) return {};
  const AllShards all = all_shards(folders);
  std::vector<MissingPart> missing;
  if (all.known.empty()) {
    missing = missing_of_undivided(folders);
  } else if (all.known.begin()->first.first == all.known.rbegin()->first.first) {
    missing = missing_shards(all);
  }
  if (missing.empty() && !folders.empty()) {
    // No shard of several divisions has what is missing of all: the study itself does it, in the
    // folder that has most.
    const auto fullest = std::ranges::max_element(
        folders, {}, [](const ShardFolder& folder) { return folder.done.size(); });
    missing.push_back({counted(missing_runs, "run"), undivided(fullest->command_line)});
  }
  return missing;
}

}  // namespace fathom
