// fathom status: how far the shards of a study are.

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "fathom/core/file_lock.hpp"
#include "fathom/core/folder_claim.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/shard_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct StatusFlags {
  std::vector<std::string> folders;
};

/// What is said of one folder.
struct FolderStatus {
  std::string folder;
  std::optional<ShardFolder> content;  ///< none where there is no store yet, or a damaged one
  std::string problem;                 ///< why a store cannot be read
  std::string at_work;                 ///< who is; empty where nobody
};

std::string worker_of(const fs::path& folder) {
  const ClaimHolder holder = FolderClaim::holder_of(folder);
  if (holder.is_alive) {
    return fmt::format("process {} on {}", holder.process, holder.host);
  }
  return FileLock::is_held(folder / "results.lock") ? "a process of this machine" : "";
}

// Of a shard, which may have begun nothing; or the store in it.
std::string folder_of(const std::string& given) {
  const fs::path path(given);
  if (fs::is_directory(path) || !fs::exists(path)) return given;
  if (path.filename() != kResultsFile) {
    throw InputError(given, std::string("is a file; expected the folder of a shard or of a study, "
                                        "or its ") +
                                kResultsFile);
  }
  return path.has_parent_path() ? path.parent_path().string() : ".";
}

// A shard that has not begun has no folder, but then another one of its study has.
void require_any(const std::vector<std::string>& folders) {
  if (std::ranges::all_of(folders, is_run_folder)) refuse_run_folder(folders.front());
  if (std::ranges::any_of(folders, [](const std::string& folder) { return fs::exists(folder); })) {
    return;
  }
  throw InputError(folders.front(), "is not there; expected the folder of a shard or of a study");
}

FolderStatus status_of(const std::string& given) {
  const std::string folder = folder_of(given);
  FolderStatus status{given, std::nullopt, "", worker_of(folder)};
  if (!fs::exists(fs::path(folder) / kResultsFile)) return status;
  try {
    status.content = shard_folder(folder, ResultStore::open(folder));
  } catch (const InputError& error) {
    status.problem = error.what();
  }
  return status;
}

std::string shards_text(const ShardFolder& content) {
  std::string text;
  for (const ShardProgress& shard : content.shards) {
    text += (text.empty() ? "" : " ") + text_of(shard.plan.shard);
  }
  return text.empty() ? "-" : text;
}

std::string state_of(const FolderStatus& status) {
  if (!status.problem.empty()) return "damaged";
  if (!status.at_work.empty()) return "running: " + status.at_work;
  if (!fs::exists(status.folder)) return "no such folder";
  if (is_run_folder(status.folder)) return "a run, no study";
  if (!status.content) return "nothing yet";
  return status.content->own_done() < status.content->own() ? "stopped" : "done";
}

// Of all folders of one study together, each run once.
void print_totals(const std::vector<ShardFolder>& folders) {
  std::set<RunKey> done;
  std::set<RunKey> failed;
  for (const ShardFolder& folder : folders) {
    done.insert(folder.done.begin(), folder.done.end());
    failed.insert(folder.failed.begin(), folder.failed.end());
  }
  const std::size_t of = runs_asked(folders);
  const std::size_t left = of - std::min(of, done.size());
  print("%zu of %zu runs are done, %zu of them failed; %zu are left\n", done.size(), of,
        failed.size(), left);
  for (const MissingPart& part : missing_parts(folders, left)) {
    print("  %s%s%s\n", part.what.c_str(), part.command.empty() ? "" : ": ", part.command.c_str());
  }
}

// Titles may be the same: the first folder tells which study is meant.
void print_totals_by_study(std::vector<ShardFolder> all) {
  const auto studies = by_study(std::move(all));
  for (const std::vector<ShardFolder>& folders : studies) {
    const ShardFolder& first = folders.front();
    print("\n");
    if (studies.size() > 1) {
      const std::string title =
          first.study.title.empty() ? "" : in_quotes(first.study.title) + " of ";
      print("%s%s: ", title.c_str(), in_quotes(first.folder.string()).c_str());
    }
    print_totals(folders);
  }
}

void show_status(const StatusFlags& flags, Context& context) {
  context.status = kDone;
  require_any(flags.folders);
  Table table({"folder", "shard", "done", "of", "failed", "state"});
  std::vector<ShardFolder> found;
  std::vector<std::string> problems;
  for (const std::string& folder : flags.folders) {
    const FolderStatus status = status_of(folder);
    if (!status.problem.empty()) problems.push_back(status.problem);
    if (status.content) {
      const ShardFolder& content = *status.content;
      table.add_row({folder, shards_text(content), std::to_string(content.own_done()),
                     std::to_string(content.own()), std::to_string(content.own_failed()),
                     state_of(status)});
      found.push_back(content);
    } else {
      table.add_row({folder, "-", "-", "-", "-", state_of(status)});
    }
  }
  print("%s", table.text().c_str());
  print_totals_by_study(std::move(found));
  for (const std::string& problem : problems) {
    print_error("fathom: error: %s\n", problem.c_str());
    context.status = kFailed;
  }
}

}  // namespace

void add_status(CLI::App& program, Context& context) {
  auto flags = std::make_shared<StatusFlags>();
  Command command(program, "status", "Say how far the shards of a study are",
                  "Example: fathom status runs/shard-*\n"
                  "Says of every folder what is done, running, failed and left, and which command "
                  "goes on.");
  command.arguments("folders", flags->folders, "Folders of the shards, or of studies");
  command.quiet();
  command.on_run([flags, &context] { show_status(*flags, context); });
}

}  // namespace fathom
