// fathom status: how far the shards of a study are.

#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <set>

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

FolderStatus status_of(const std::string& folder) {
  FolderStatus status{folder, std::nullopt, "", worker_of(folder)};
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
  if (!status.content) return "nothing yet";
  return status.content->done.size() < status.content->own() ? "stopped" : "done";
}

// Of all folders of one study together, each run once.
void print_totals(const std::vector<ShardFolder>& folders) {
  std::set<RunKey> done;
  std::set<RunKey> failed;
  for (const ShardFolder& folder : folders) {
    done.insert(folder.done.begin(), folder.done.end());
    failed.insert(folder.failed.begin(), folder.failed.end());
  }
  const std::size_t of = folders.front().of;
  const std::size_t left = of - std::min(of, done.size());
  print("%zu of %zu runs are done, %zu of them failed; %zu are left\n", done.size(), of,
        failed.size(), left);
  for (const MissingPart& part : missing_parts(folders, left)) {
    print("  %s%s%s\n", part.what.c_str(), part.command.empty() ? "" : ": ", part.command.c_str());
  }
}

// Studies have no name but what they are called and how large they are.
void print_totals_by_study(const std::vector<ShardFolder>& all) {
  std::map<std::pair<std::string, std::size_t>, std::vector<ShardFolder>> studies;
  for (const ShardFolder& folder : all) studies[{folder.title, folder.of}].push_back(folder);
  for (const auto& [study, folders] : studies) {
    print("\n");
    if (studies.size() > 1) print("%s: ", in_quotes(study.first).c_str());
    print_totals(folders);
  }
}

void show_status(const StatusFlags& flags, Context& context) {
  context.status = kDone;
  Table table({"folder", "shard", "done", "of", "failed", "state"});
  std::vector<ShardFolder> found;
  std::vector<std::string> problems;
  for (const std::string& folder : flags.folders) {
    const FolderStatus status = status_of(folder);
    if (!status.problem.empty()) problems.push_back(status.problem);
    if (status.content) {
      const ShardFolder& content = *status.content;
      table.add_row({folder, shards_text(content), std::to_string(content.done.size()),
                     std::to_string(content.own()), std::to_string(content.failed.size()),
                     state_of(status)});
      found.push_back(content);
    } else {
      table.add_row({folder, "-", "-", "-", "-", state_of(status)});
    }
  }
  print("%s", table.text().c_str());
  print_totals_by_study(found);
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
  command.on_run([flags, &context] { show_status(*flags, context); });
}

}  // namespace fathom
