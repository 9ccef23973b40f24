// fathom merge: one study of its shards, or one cache of registrations of several.

#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/workflow/merge.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

struct MergeFlags {
  std::vector<std::string> folders;
  std::string out;
  bool quiet = false;

  std::vector<fs::path> paths() const { return {folders.begin(), folders.end()}; }
};

void merge_studies(const MergeFlags& flags, Context& context) {
  Terminal terminal(flags.quiet);
  const workflow::MergeOutcome done = workflow::merge_studies(flags.paths(), flags.out, terminal);
  const MergeSummary& merged = done.merged;
  if (!flags.quiet) {
    if (!done.table.empty()) print("%s\n", done.table.c_str());
    terminal.print_written();
    print("%zu folders: %zu of %zu runs", merged.sources, merged.runs, merged.of);
    if (merged.repeated > 0) print(", %zu of them in several, alike", merged.repeated);
    if (merged.machines > 1) {
      print(", from %zu kinds of processor, whose costs are kept apart", merged.machines);
    }
    print("\n");
    terminal.print_remarks();
  }
  if (!done.all_usable) context.status = kFailed;
  if (merged.is_complete()) return;
  print_error("fathom: the study is not finished; missing:\n");
  for (const MissingPart& part : merged.missing) {
    print_error("  %s%s%s\n", part.what.c_str(), part.command.empty() ? "" : ": ",
                part.command.c_str());
  }
  context.status = kFailed;
}

void merge_caches(const MergeFlags& flags) {
  const MergedRegistrations merged = merge_registrations(flags.paths(), flags.out);
  if (flags.quiet) return;
  print("%zu registrations are in %s; %zu were in several, alike\n", merged.count,
        flags.out.c_str(), merged.repeated);
}

void merge(const MergeFlags& flags, Context& context) {
  context.status = kDone;
  if (workflow::are_caches(flags.paths())) {
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
