// fathom compare: a study. A data set, several estimators, surveys, many trials, perhaps a sweep.

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include <opencv2/core/utility.hpp>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/memory_meter.hpp"
#include "apps/pin_threads.hpp"
#include "apps/study_example.hpp"
#include "apps/study_progress.hpp"
#include "fathom/core/files.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/ground_truth.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/harness/study_run.hpp"
#include "fathom/report/study_report.hpp"
#include "fathom/results/run_index.hpp"
#include "fathom/results/store_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

std::atomic<bool> stop_asked = false;

// The first one lets the trials at work end; the second ends the program, which harms no store.
extern "C" void ask_to_stop(int signal) {
  stop_asked = true;
  std::signal(signal, SIG_DFL);
}

struct CompareFlags {
  CommonFlags common;
  std::string config;
  std::optional<int> surveys;
  std::optional<int> trials;
  std::optional<int> jobs;
  std::string cache;
  bool no_cache = false;
  bool no_mosaic = false;

  Settings settings() const {
    Settings settings = common.settings(config);
    if (surveys) {
      settings.put({"surveys", OptionValue::scalar(std::to_string(*surveys)), "--surveys"});
    }
    if (trials) settings.put({"trials", OptionValue::scalar(std::to_string(*trials)), "--trials"});
    if (jobs) settings.put({"jobs", OptionValue::scalar(std::to_string(*jobs)), "--jobs"});
    return settings;
  }
};

std::unique_ptr<RegistrationStore> open_cache(const CompareFlags& flags) {
  if (flags.no_cache) return nullptr;
  auto cache = std::make_unique<RegistrationStore>(flags.cache.empty() ? default_cache_folder()
                                                                       : fs::path(flags.cache));
  if (!cache->problem().empty() && !flags.common.quiet) {
    std::fprintf(stderr, "fathom: note: no registration cache: %s\n", cache->problem().c_str());
  }
  return cache;
}

// Said before anything is computed.
void require_separate(const fs::path& out, const Study& study,
                      const std::vector<fs::path>& inputs) {
  std::vector<std::string> names{"results.sqlite",     "report.html",      "runs.csv",
                                 "summary.csv",        "tables.tex",       "figures",
                                 "trajectories.png",   "metrics.json",     "table.txt",
                                 "dead_reckoning.tum", "measurements.g2o", "ground_truth.tum"};
  for (const EstimatorConfiguration& one : study.cells.front().estimators)
    names.push_back(one.name);
  for (const std::string& name : names) refuse_replacing(out / name, inputs);
}

// An estimator that no trial of any cell could use has failed.
int status_of(const ResultStore& store) {
  std::set<std::string> usable;
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator != kDeadReckoning && !is_failed(run)) usable.insert(run.key.estimator);
  }
  return usable.size() == store.study().estimators.size() ? kDone : kFailed;
}

StudyRun run(const Study& study, ResultStore& store, StudyRunOptions options, bool quiet) {
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  StudyProgressLine line(quiet);
  options.progress = [&line](const StudyProgress& progress) { line.show(progress); };
  StudyRun done = run_study(study, builtin_estimators(), store, options);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  return done;
}

void compare(const CompareFlags& flags, Context& context) {
  Study study = configure_study(flags.settings(), builtin_estimators());
  const fs::path out = flags.common.folder_or(stem_of(flags.config));
  require_separate(out, study, inputs_of(flags.config, flags.settings()));
  const std::unique_ptr<RegistrationStore> cache = open_cache(flags);
  // A data set that cannot be opened, or lacks what is asked for, is refused before anything is
  // written.
  settle_reference(study, builtin_estimators());
  study.description.data = data_of(study);
  const Recorder data_set(study.cells.front(), cache.get());
  const int jobs = jobs_of(study);
  // The threads there are for all jobs together; no result depends on them.
  cv::setNumThreads(std::max(1, cv::getNumThreads() / jobs));
  StoreFolder folder(out, study.description, session_json(context.command_line, jobs));
  ResultStore& store = folder.store();

  StudyRunOptions options;
  options.jobs = jobs;
  options.registrations = cache.get();
  options.make_meter = make_memory_meter;
  options.on_thread_start = pin_threads;
  options.stop = &stop_asked;
  const StudyRun done = run(study, store, options, flags.common.quiet);
  if (!done.is_finished) {
    std::fprintf(stderr,
                 "fathom: stopped; %zu runs are in %s. The same command goes on from there.\n",
                 store.runs().size(), (out / "results.sqlite").c_str());
    context.status = kStopped;
    return;
  }
  store.finish();
  const std::string title =
      study.description.title.empty() ? stem_of(flags.config) : study.description.title;
  write_example(out, study, done.example, title, flags.no_mosaic ? nullptr : data_set.pictures(),
                flags.common.quiet, context);
  write_study_report(store, out);
  const std::string table = study_table(store);
  write_file(out / "table.txt", table);
  context.status = status_of(store);
  if (flags.common.quiet) return;
  // A sweep of many cells would scroll away.
  constexpr std::size_t kCellsInFull = 3;
  const bool brief = study.cells.size() > kCellsInFull;
  std::printf("%s\nwrote %s\n      %s\n",
              brief ? study_table(store, StudyTable::brief).c_str() : table.c_str(),
              (out / "report.html").c_str(), (out / "trajectories.png").c_str());
  if (brief)
    std::printf("      %s: all metrics, and the estimators' differences\n",
                (out / "table.txt").c_str());
}

}  // namespace

void add_compare(CLI::App& program, Context& context) {
  auto flags = std::make_shared<CompareFlags>();
  Command command(
      program, "compare", "Run a study: several estimators, surveys, many trials, a sweep",
      "Example: fathom compare configs/quickstart.yaml --out runs/quickstart\n"
      "         fathom compare configs/studies/paper_simulated.yaml --trials 5 --jobs 2\n"
      "A study that was stopped or killed goes on where it was: run the same command again.");
  command.argument("config", flags->config, "Study (YAML)");
  flags->common.add_settings_to(command);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name)");
  command.integer("--surveys", flags->surveys, Range::any(), "N",
                  "Surveys in every cell: floor, attitude and sensors drawn anew");
  command.integer("--trials", flags->trials, Range::any(), "N",
                  "Trials in every survey, for a quick look");
  command.integer("--jobs", flags->jobs, Range::any(), "N", "Trials at work at the same time");
  command.text("--cache", flags->cache, "DIR",
               "Folder of the registrations that are kept from study to study "
               "(default: $FATHOM_CACHE, or ~/.cache/fathom)");
  command.boolean("--no-cache", flags->no_cache, "Neither read nor write kept registrations");
  command.boolean("--no-mosaic", flags->no_mosaic, "No mosaics of the pictures");
  command.on_run([flags, &context] { compare(*flags, context); });
}

}  // namespace fathom
