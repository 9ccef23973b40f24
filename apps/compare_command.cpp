// fathom compare: a study. A data set, several estimators, surveys, many trials, perhaps a sweep.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <opencv2/core/utility.hpp>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/compare_modes.hpp"
#include "apps/estimators.hpp"
#include "apps/memory_meter.hpp"
#include "apps/pin_threads.hpp"
#include "apps/study_files.hpp"
#include "fathom/core/files.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/study_run.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<RegistrationStore> open_cache(const CompareFlags& flags) {
  if (flags.no_cache) return nullptr;
  if (!flags.read_only_cache.empty()) return RegistrationStore::read_only(flags.read_only_cache);
  auto cache =
      open_registrations(flags.cache.empty() ? default_cache_folder() : fs::path(flags.cache),
                         flags.common.quiet || flags.only_registrations);
  if (flags.only_registrations && !cache->problem().empty()) throw InputError(cache->problem());
  return cache;
}

void compare_as(const std::optional<Shard>& shard, const CompareFlags& flags, Context& context) {
  Study study = configure_study(flags.settings(), estimators());
  const fs::path out = flags.common.folder_or(stem_of(flags.config));
  if (!flags.only_registrations) {
    require_separate(out, study, inputs_of(flags.config, flags.settings()));
  }
  const std::unique_ptr<RegistrationStore> cache = open_cache(flags);
  // A data set that cannot be opened, or lacks what is asked for, is refused before anything is
  // written.
  settle_reference(study, estimators());
  study.description.data = with_code(data_of(study), estimators_in(study.cells), estimators());
  const Recorder data_set(study.cells.front(), cache.get());

  StudyRunOptions options;
  options.jobs = jobs_of(study);
  // The threads there are for all jobs together; no result depends on them.
  cv::setNumThreads(std::max(1, cv::getNumThreads() / options.jobs));
  options.registrations = cache.get();
  options.make_meter = make_memory_meter;
  options.on_thread_start = pin_threads;
  if (shard) options.shard = *shard;
  if (flags.only_registrations) {
    only_register(study, *cache, options, flags, context);
  } else if (shard) {
    run_shard(study, *shard, out, data_set.pictures(), options, cache.get(), flags, context);
  } else {
    run_whole(study, out, data_set.pictures(), options, cache.get(), flags, context);
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
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name)");
  command.integer("--surveys", flags->surveys, Range::any(), "N",
                  "Surveys in every cell: floor, attitude and sensors drawn anew");
  command.integer("--trials", flags->trials, Range::any(), "N",
                  "Trials in every survey, for a quick look");
  command.integer("--jobs", flags->jobs, Range::any(), "N", "Trials at work at the same time");
  const Flag cache = command.text("--cache", flags->cache, "DIR",
                                  "Folder of the registrations that are kept from study to study "
                                  "(default: $FATHOM_CACHE, or ~/.cache/fathom)");
  const Flag read_only = command.text("--read-only-cache", flags->read_only_cache, "DIR",
                                      "The same, only read: many machines may do so at once");
  const Flag no_cache =
      command.boolean("--no-cache", flags->no_cache, "Neither read nor write kept registrations");
  command.text("--shard", flags->shard, "K/N",
               "Do the K-th of N parts of the study; 'fathom merge' makes one of them");
  command.text("--scratch", flags->scratch, "DIR",
               "Folder on a disk of this machine for the store of a shard while it runs "
               "(default: $TMPDIR, or /tmp)");
  const Flag only = command.boolean("--only-registrations", flags->only_registrations,
                                    "Register the pictures into the cache, and run nothing");
  read_only.excludes(cache).excludes(no_cache).excludes(only);
  no_cache.excludes(cache).excludes(only);
  command.boolean("--no-mosaic", flags->no_mosaic, "No mosaics of the pictures");
  command.on_run([flags, &context] { compare(*flags, context); });
}

}  // namespace fathom
