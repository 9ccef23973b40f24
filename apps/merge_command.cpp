// fathom merge: one study of its shards, or one cache of registrations of several.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/study_files.hpp"
#include "fathom/core/files.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/results/merge.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct MergeFlags {
  std::vector<std::string> folders;
  std::string out;
  bool quiet = false;

  std::vector<fs::path> paths() const { return {folders.begin(), folders.end()}; }
};

// The example of a study, which one shard has: runs with their files, and what they share.
void copy_example(const std::vector<fs::path>& folders, const fs::path& out,
                  const StudyDescription& study) {
  const auto has_example = [](const fs::path& folder) {
    return fs::exists(folder / "trajectories.png");
  };
  const auto source = std::ranges::find_if(folders, has_example);
  if (source == folders.end() || fs::equivalent(*source, out)) return;
  std::vector<std::string> names{"metrics.json", "trajectories.png", "dead_reckoning.tum",
                                 "measurements.g2o", "ground_truth.tum"};
  for (const StudyEstimator& estimator : study.estimators) names.push_back(estimator.name);
  StagedFolder staged(out);
  for (const std::string& name : names) {
    if (!fs::exists(*source / name)) continue;
    fs::copy(*source / name, staged.path() / name, fs::copy_options::recursive);
  }
  staged.commit();
}

void merge_studies(const MergeFlags& flags, Context& context) {
  const MergeSummary merged = merge_stores(flags.paths(), flags.out);
  const ResultStore store = ResultStore::open(flags.out);
  copy_example(flags.paths(), flags.out, store.study());
  if (merged.runs > 0) write_study_files(store, flags.out, flags.quiet);
  if (!flags.quiet) {
    std::printf("%zu folders: %zu of %zu runs", merged.sources, merged.runs, merged.of);
    if (merged.repeated > 0) std::printf(", %zu of them in several, alike", merged.repeated);
    if (merged.machines > 1) {
      std::printf(", from %zu kinds of processor, whose costs are kept apart", merged.machines);
    }
    std::printf("\n");
  }
  if (merged.is_complete()) return;
  std::fprintf(stderr, "fathom: the study is not finished; missing:\n");
  for (const MissingPart& part : merged.missing) {
    std::fprintf(stderr, "  %s%s%s\n", part.what.c_str(), part.command.empty() ? "" : ": ",
                 part.command.c_str());
  }
  context.status = kFailed;
}

void merge_caches(const MergeFlags& flags) {
  const MergedRegistrations merged = merge_registrations(flags.paths(), flags.out);
  if (flags.quiet) return;
  std::printf("%zu registrations are in %s; %zu were in several, alike\n", merged.count,
              flags.out.c_str(), merged.repeated);
}

void merge(const MergeFlags& flags, Context& context) {
  context.status = kDone;
  const bool are_caches = std::ranges::all_of(flags.folders, [](const std::string& folder) {
    return has_registrations(folder) && !fs::exists(fs::path(folder) / kResultsFile);
  });
  if (are_caches) {
    merge_caches(flags);
  } else {
    merge_studies(flags, context);
  }
}

}  // namespace

void add_merge(CLI::App& program, Context& context) {
  auto flags = std::make_shared<MergeFlags>();
  Command command(
      program, "merge", "Make one study of its shards",
      "Example: fathom merge runs/shard-* --out runs/study\n"
      "The content is that of an undivided run. What is missing is listed with the command that\n"
      "does it; the exit status is then 1. Folders of registrations (--cache) are merged as well.");
  command.arguments("folders", flags->folders, "Folders of the shards");
  command.text("--out", flags->out, "DIR", "Folder of the whole study").required();
  command.boolean("--quiet", flags->quiet, "No output but errors");
  command.on_run([flags, &context] { merge(*flags, context); });
}

}  // namespace fathom
