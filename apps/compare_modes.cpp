#include "apps/compare_modes.hpp"

#include <cstdio>
#include <set>

#include "apps/estimators.hpp"
#include "apps/stop_signal.hpp"
#include "apps/study_example.hpp"
#include "apps/study_files.hpp"
#include "apps/study_progress.hpp"
#include "fathom/harness/loop_remarks.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/run_index.hpp"
#include "fathom/results/scratch_store.hpp"
#include "fathom/results/store_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

// An estimator that no trial of any cell could use has failed.
int status_of(const ResultStore& store) {
  std::set<std::string> usable;
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator != kDeadReckoning && !is_failed(run)) usable.insert(run.key.estimator);
  }
  return usable.size() == store.study().estimators.size() ? kDone : kFailed;
}

// Runs an action that shows its progress and can be asked to stop.
template <class Action>
auto stoppable(StudyRunOptions& options, RegistrationStore* cache, bool quiet, Action action) {
  const StopSignal stop(quiet, [cache] {
    if (cache != nullptr) cache->flush();
  });
  options.stop = stop.flag();
  StudyProgressLine line(quiet);
  const auto also = options.progress;
  options.progress = [&line, also](const StudyProgress& progress) {
    line.show(progress);
    if (also) also(progress);
  };
  return action();
}

StudyRun run(const Study& study, ResultStore& store, StudyRunOptions& options,
             RegistrationStore* cache, bool quiet) {
  return stoppable(options, cache, quiet,
                   [&] { return run_study(study, estimators(), store, options); });
}

std::string title_of(const Study& study, const CompareFlags& flags) {
  return study.description.title.empty() ? stem_of(flags.config) : study.description.title;
}

void say_stopped(std::size_t runs, const fs::path& out, Context& context) {
  std::fprintf(stderr,
               "fathom: stopped; %zu runs are in %s. The same command goes on from there.\n", runs,
               (out / kResultsFile).c_str());
  context.status = kStopped;
}

void write_example(const fs::path& out, const Study& study, const StudyRun& done,
                   const FrameSource* pictures, const CompareFlags& flags, const Context& context) {
  write_example(out, study, done.example, title_of(study, flags),
                flags.no_mosaic ? nullptr : pictures, flags.common.quiet, estimators(),
                context.command_line);
}

// What looks wrong with the loops of the trial that is drawn; the page says what its figures show.
void print_remarks(const Study& study, const StudyRun& done) {
  if (done.example.empty()) return;
  const ExampleRun& example = done.example.front();
  for (const std::string& remark : loop_remarks(*example.recording, study.cells.front().front_end,
                                                example.result.replay.trajectory)) {
    std::printf("\nwarning: %s\n", remark.c_str());
  }
}

}  // namespace

void run_shard(const Study& study, const Shard& shard, const fs::path& out,
               const FrameSource* pictures, StudyRunOptions& options, RegistrationStore* cache,
               const CompareFlags& flags, Context& context) {
  const ShardPlan plan{shard, runs_of(study, shard), context.command_line};
  const fs::path scratch =
      flags.scratch.empty() ? fs::temp_directory_path() : fs::path(flags.scratch);
  ScratchStore store(out, scratch, study.description, session_json(plan, options.jobs));
  options.shard = shard;
  options.progress = [&store](const StudyProgress&) { store.publish_when_due(); };
  const StudyRun done = run(study, store.store(), options, cache, flags.common.quiet);
  store.publish();
  if (!done.is_finished) {
    say_stopped(store.store().runs().size(), out, context);
    return;
  }
  if (!done.example.empty()) write_example(out, study, done, pictures, flags, context);
  if (flags.common.quiet) return;
  std::printf("shard %s: %zu runs are in %s\n'fathom merge' makes one study of all shards.\n",
              text_of(shard).c_str(), plan.runs, (out / kResultsFile).c_str());
}

void run_whole(const Study& study, const fs::path& out, const FrameSource* pictures,
               StudyRunOptions& options, RegistrationStore* cache, const CompareFlags& flags,
               Context& context) {
  StoreFolder folder(out, study.description, session_json(context.command_line, options.jobs));
  ResultStore& store = folder.store();
  const StudyRun done = run(study, store, options, cache, flags.common.quiet);
  if (!done.is_finished) {
    say_stopped(store.runs().size(), out, context);
    return;
  }
  store.finish();
  write_example(out, study, done, pictures, flags, context);
  write_study_files(store, out, flags.common.quiet);
  if (!flags.common.quiet) print_remarks(study, done);
  context.status = status_of(store);
}

void only_register(const Study& study, RegistrationStore& cache, StudyRunOptions& options,
                   const CompareFlags& flags, Context& context) {
  const bool is_finished = stoppable(options, &cache, flags.common.quiet, [&] {
    return register_pictures(study, estimators(), options);
  });
  cache.flush();
  if (const std::string problem = cache.problem(); !problem.empty()) throw InputError(problem);
  if (is_finished) return;
  std::fprintf(stderr, "fathom: stopped; what is registered is kept.\n");
  context.status = kStopped;
}

}  // namespace fathom
