// fathom compare: a study. A data set, several estimators, surveys, many trials, perhaps a sweep.

#include <filesystem>
#include <memory>
#include <optional>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/stop_signal.hpp"
#include "apps/terminal.hpp"
#include "fathom/workflow/compare.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

// The flags of `compare`.
struct CompareFlags {
  CommonFlags common;
  std::string config;
  std::optional<int> surveys;
  std::optional<int> trials;
  std::optional<int> jobs;
  CacheFlags cache;
  std::string read_only_cache;
  bool only_registrations = false;
  std::string shard;
  std::string scratch;
  bool no_mosaic = false;

  Settings settings() const {
    Settings settings = common.settings(config, workflow::NamedPlugins::loaded);
    if (surveys) {
      settings.put({"surveys", OptionValue::scalar(std::to_string(*surveys)), "--surveys"});
    }
    if (trials) settings.put({"trials", OptionValue::scalar(std::to_string(*trials)), "--trials"});
    if (jobs) settings.put({"jobs", OptionValue::scalar(std::to_string(*jobs)), "--jobs"});
    return settings;
  }
};

std::unique_ptr<RegistrationStore> open_cache(const CompareFlags& flags) {
  if (!flags.read_only_cache.empty()) return RegistrationStore::read_only(flags.read_only_cache);
  auto cache = flags.cache.open(flags.common.quiet || flags.only_registrations);
  if (flags.only_registrations && !cache->problem().empty()) throw InputError(cache->problem());
  return cache;
}

void register_only(const CompareFlags& flags, const workflow::CompareRequest& request,
                   Terminal& terminal, Context& context) {
  const bool is_finished =
      workflow::register_study(request, flags.common.estimators(), this_program(), terminal);
  terminal.clear();
  if (is_finished) return;
  print_error("fathom: stopped; what is registered is kept.\n");
  context.status = kStopped;
}

void run_study(const CompareFlags& flags, const workflow::CompareRequest& request,
               Terminal& terminal, Context& context) {
  const workflow::CompareOutcome done =
      workflow::compare(request, flags.common.estimators(), this_program(), terminal);
  terminal.clear();
  const std::string store = (request.out / kResultsFile).string();
  if (!done.is_finished) {
    if (fs::exists(store)) {
      print_error("fathom: stopped; %zu runs are in %s. The same command goes on from there.\n",
                  done.runs, store.c_str());
    } else {
      print_error("fathom: stopped before a run was stored.\n");
    }
    context.status = kStopped;
    return;
  }
  context.status = done.all_usable ? kDone : kFailed;
  if (flags.common.quiet) return;
  if (request.shard) {
    print("shard %s: %zu runs are in %s\n'fathom merge' makes one study of all shards.\n",
          text_of(*request.shard).c_str(), done.runs, store.c_str());
    terminal.print_remarks();
    return;
  }
  print("%s\n", done.table.c_str());
  terminal.print_written();
  terminal.print_remarks();
}

void compare_as(const std::optional<Shard>& shard, const CompareFlags& flags, Context& context) {
  workflow::CompareRequest request;
  request.settings = flags.settings();
  request.inputs = workflow::inputs_of(flags.config, request.settings);
  request.title = workflow::stem_of(flags.config);
  if (!flags.only_registrations) request.out = flags.common.folder_or(request.title + "-study");
  request.made_by = context.command_line;
  request.mosaics = !flags.no_mosaic;
  request.shard = shard;
  request.scratch = flags.scratch;
  const std::unique_ptr<RegistrationStore> cache = open_cache(flags);
  request.registrations = cache.get();
  // It may be asked to end at any time from here on.
  const StopSignal stop(flags.common.quiet, [&cache] {
    if (cache) cache->flush();
  });
  request.stop = stop.flag();
  Terminal terminal(flags.common.quiet);
  if (flags.only_registrations) {
    register_only(flags, request, terminal, context);
  } else {
    run_study(flags, request, terminal, context);
  }
}

void compare(const CompareFlags& flags, Context& context) {
  if (flags.shard.empty()) {
    if (!flags.scratch.empty()) throw InputError("--scratch: goes with --shard K/N");
    return compare_as(std::nullopt, flags, context);
  }
  const Shard shard = parse_shard(flags.shard);
  try {
    compare_as(shard, flags, context);
  } catch (const InputError& error) {
    throw InputError("shard " + text_of(shard) + ": " + error.what());
  }
}

}  // namespace

void add_compare(CLI::App& program, Context& context) {
  auto flags = std::make_shared<CompareFlags>();
  Command command(
      program, "compare", "Run a study: several estimators, surveys, many trials, a sweep",
      "Example: fathom compare configs/quickstart.yaml --out runs/quickstart\n"
      "         fathom compare configs/studies/paper_simulated.yaml --trials 5 --jobs 2\n"
      "A study that was stopped or killed goes on where it was: run the same command again.");
  command.argument("config", flags->config,
                   "Study (YAML), or a folder of pictures, plain or in the EuRoC/ASL layout");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name-study)");
  command.integer("--surveys", flags->surveys, Range::any(), "N",
                  "Surveys in every cell: floor, attitude and sensors drawn anew");
  command.integer("--trials", flags->trials, Range::any(), "N",
                  "Trials in every survey, for a quick look");
  command.integer("--jobs", flags->jobs, Range::any(), "N", "Trials at work at the same time");
  const std::array<Flag, 2> cache = flags->cache.add_to(command);
  const Flag read_only = command.text("--read-only-cache", flags->read_only_cache, "DIR",
                                      "As --cache, only read: many machines may do so at once");
  command.text("--shard", flags->shard, "K/N",
               "Do the K-th of N parts of the study; 'fathom merge' makes one of them");
  command.text("--scratch", flags->scratch, "DIR",
               "Folder on a disk of this machine for the store of a shard while it runs "
               "(default: $TMPDIR, or /tmp)");
  const Flag only = command.boolean("--only-registrations", flags->only_registrations,
                                    "Register the pictures into the cache, and run nothing");
  read_only.excludes(cache[0]).excludes(cache[1]).excludes(only);
  only.excludes(cache[1]);
  command.boolean("--no-mosaic", flags->no_mosaic, "No mosaics of the pictures");
  command.on_run([flags, &context] { compare(*flags, context); });
}

}  // namespace fathom
