#include "fathom/results/merge.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "fathom/core/file_lock.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/folder_claim.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/shard_folder.hpp"
#include "result_schema.hpp"
#include "settled_store.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct Source {
  fs::path folder;
  ResultStore store;
  std::vector<std::string> manifests;
};

ResultStore open_source(const fs::path& folder) {
  try {
    return ResultStore::open(folder);
  } catch (const InputError& error) {
    throw InputError(fmt::format("shard {}: {}", folder.string(), error.what()));
  }
}

// Each folder once, by whatever path it is named.
std::vector<Source> open_sources(const std::vector<fs::path>& folders, const fs::path& out) {
  std::vector<fs::path> wanted = folders;
  if (fs::exists(out / kResultsFile)) wanted.push_back(out);
  std::set<fs::path> seen;
  std::vector<Source> sources;
  for (const fs::path& folder : wanted) {
    std::error_code error;
    const fs::path canonical = fs::weakly_canonical(folder, error);
    if (!seen.insert(error ? folder : canonical).second) continue;
    ResultStore store = open_source(folder);
    std::vector<std::string> manifests = store.manifests();
    sources.push_back({folder, std::move(store), std::move(manifests)});
  }
  // Nothing below depends on the order in which they were named.
  std::ranges::sort(sources, {}, &Source::manifests);
  return sources;
}

void require_same_study(const std::vector<Source>& sources) {
  const Source& first = sources.front();
  for (const Source& other : sources) {
    const StudyDescription &there = first.store.study(), &here = other.store.study();
    std::string differs = difference(there, here);
    if (differs.empty()) differs = data_difference(there, here);
    if (differs.empty()) continue;
    throw InputError(fmt::format(
        "shard {}: is of another study than shard {} ({}); merge the shards of one study alone",
        other.folder.string(), first.folder.string(), differs));
  }
}

StudyDescription study_of(const std::vector<Source>& sources) {
  StudyDescription study = sources.front().store.study();
  for (const Source& source : sources) {
    study.surveys = std::max(study.surveys, source.store.study().surveys);
    study.trials = std::max(study.trials, source.store.study().trials);
  }
  return study;
}

bool is_cost_series(const std::string& name) {
  return name == "update_ms";
}

bool are_alike(double one, double other) {
  return one == other || (std::isnan(one) && std::isnan(other));
}

bool are_alike(const std::vector<double>& one, const std::vector<double>& other) {
  return std::ranges::equal(one, other, [](double a, double b) { return are_alike(a, b); });
}

// The first name under which two maps differ, but for those of cost; empty where none does.
template <class Map, class IsCost>
std::string first_difference(const Map& one, const Map& other, const IsCost& is_cost) {
  std::set<std::string> names;
  for (const auto& [name, value] : one) names.insert(name);
  for (const auto& [name, value] : other) names.insert(name);
  for (const std::string& name : names) {
    if (is_cost(name)) continue;
    const auto a = one.find(name);
    const auto b = other.find(name);
    if (a == one.end() || b == other.end() || !are_alike(a->second, b->second)) return name;
  }
  return "";
}

std::string value_text(const std::map<std::string, double>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  return found == metrics.end() ? "none" : exact(found->second);
}

// What differs of two runs of one key, cost apart; empty where nothing does.
std::string difference_of(const RunRecord& one, const RunRecord& other) {
  if (one.outcome != other.outcome) return "outcome " + one.outcome + " and " + other.outcome;
  if (one.fault != other.fault) return "fault '" + one.fault + "' and '" + other.fault + "'";
  if (one.log_hash != other.log_hash) return "other measurements";
  const std::string metric = first_difference(one.metrics, other.metrics, is_cost_metric);
  if (!metric.empty()) {
    return fmt::format("{} {} and {}", metric, value_text(one.metrics, metric),
                       value_text(other.metrics, metric));
  }
  const std::string series = first_difference(one.series, other.series, is_cost_series);
  return series.empty() ? "" : "series " + series;
}

// One run in one source.
struct Copy {
  const Source* source = nullptr;
  const std::string* manifest = nullptr;
  std::string costs;  ///< tells copies of one session apart
};

using Copies = std::map<RunKey, std::vector<Copy>>;

std::string text_of_costs(const RunRecord& run) {
  std::string text = std::to_string(run.jobs);
  for (const auto& [name, value] : run.metrics) {
    if (is_cost_metric(name)) text += " " + exact(value);
  }
  return text;
}

Copies copies_of(const std::vector<Source>& sources) {
  Copies copies;
  for (const Source& source : sources) {
    for (const RunRecord& run : source.store.runs()) {
      copies[run.key].push_back({&source, &source.manifests.at(run.session), text_of_costs(run)});
    }
  }
  for (auto& [key, own] : copies) {
    std::ranges::sort(own, [](const Copy& one, const Copy& other) {
      return std::tie(*one.manifest, one.costs) < std::tie(*other.manifest, other.costs);
    });
  }
  return copies;
}

RunRecord run_of(const Source& source, const RunKey& key) {
  std::optional<RunRecord> run = source.store.run(key);
  if (run) return std::move(*run);
  throw InputError(source.store.file().string(),
                   fmt::format("is damaged: {}, {}, is in its list of runs and is not found{}",
                               key.estimator, text_of(key.trial_key()), kRemedy));
}

void require_alike(const RunKey& key, const RunRecord& kept, const Source& of_kept,
                   const Source& source, const StudyDescription& study) {
  const RunRecord other = run_of(source, key);
  const std::string differs = difference_of(kept, other);
  if (differs.empty()) return;
  throw InputError(
      fmt::format("shard {}: {}, {}, cell '{}' is not as in shard {} ({}); the same run gives the "
                  "same result: find out which one is wrong and run it again",
                  source.folder.string(), key.estimator, text_of(key.trial_key()),
                  study.label_of(key.cell), of_kept.folder.string(), differs));
}

// The kept copies by session, sessions in the order of their manifests.
std::map<std::string, std::vector<RunKey>> runs_by_session(const Copies& copies) {
  std::map<std::string, std::vector<RunKey>> runs;
  for (const auto& [key, own] : copies) runs[*own.front().manifest].push_back(key);
  return runs;
}

void write_merged(const fs::path& folder, const StudyDescription& study, const Copies& copies) {
  const auto sessions = runs_by_session(copies);
  ResultStore merged =
      ResultStore::write(folder, study, sessions.empty() ? "{}\n" : sessions.begin()->first);
  for (auto session = sessions.begin(); session != sessions.end(); ++session) {
    if (session != sessions.begin()) merged.begin_session(session->first);
    for (const RunKey& key : session->second) {
      const std::vector<Copy>& own = copies.at(key);
      const RunRecord kept = run_of(*own.front().source, key);
      for (auto other = own.begin() + 1; other != own.end(); ++other) {
        require_alike(key, kept, *own.front().source, *other->source, study);
      }
      merged.add(kept);
    }
  }
  merged.finish();
}

std::set<std::string> machines_of(const std::vector<Source>& sources) {
  std::set<std::string> machines;
  for (const Source& source : sources) {
    for (const RunRecord& run : source.store.runs()) machines.insert(run.machine);
  }
  return machines;
}

}  // namespace

MergeSummary merge_stores(const std::vector<fs::path>& folders, const fs::path& out) {
  if (folders.empty()) throw InputError("merge: no folder of a shard was given");
  StagedFolder staged(out);
  const FolderClaim claim(staged.target());
  settle_store(staged.target());
  const FileLock lock(staged.target() / "results.lock",
                      out.string() + ": another process is at work on it; use another --out");
  const std::vector<Source> sources = open_sources(folders, out);
  require_same_study(sources);
  const StudyDescription study = study_of(sources);
  const Copies copies = copies_of(sources);
  MergeSummary summary;
  summary.sources = sources.size();
  for (const auto& [key, own] : copies) {
    if (key.estimator == kDeadReckoning) continue;
    ++summary.runs;
    if (own.size() > 1) ++summary.repeated;
  }
  summary.of = study.cell_count() * study.surveys * study.trials * study.estimators.size();
  summary.machines = machines_of(sources).size();
  std::vector<ShardFolder> shards;
  shards.reserve(sources.size());
  for (const Source& source : sources) shards.push_back(shard_folder(source.folder, source.store));
  summary.missing = missing_parts(shards, summary.of - summary.runs);
  write_merged(staged.path(), study, copies);
  staged.commit();
  return summary;
}

}  // namespace fathom
