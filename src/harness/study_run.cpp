#include "fathom/harness/study_run.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

#include "fathom/core/random.hpp"
#include "fathom/harness/isolated_replay.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/run_record.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/results/run_index.hpp"
#include "recorded_trial.hpp"
#include "study_data_sets.hpp"
#include "study_tasks.hpp"
#include "study_watch.hpp"

namespace fathom {
namespace {

class Runner {
 public:
  // Without a store pictures are registered, and that is all.
  Runner(const Study& study, const EstimatorRegistry& registry, ResultStore* store,
         const StudyRunOptions& options)
      : study_(study),
        registry_(registry),
        store_(store),
        options_(options),
        data_sets_(study, options.registrations),
        own_(options.sample ? ShardTrials(study, *options.sample)
                            : ShardTrials(study, data_sets_, options.shard)),
        tasks_(tasks_to_do()),
        threads_(std::min(static_cast<std::size_t>(options.jobs),
                          std::max<std::size_t>(tasks_.size(), 1))),
        watch_(options, runs() - runs_in(tasks_), runs(),
               StudyPace(work_of(study, data_sets_, tasks_, store != nullptr), threads_)) {
    for (const Task& task : tasks_) data_sets_.expect_trial(task.cell, task.survey);
  }

  /// False where it was stopped before the end.
  bool run() {
    {
      std::vector<std::jthread> others;
      others.reserve(threads_);
      start_others(others, threads_ - 1);
      work();
    }
    if (failure_) std::rethrow_exception(failure_);
    return done_tasks_ == tasks_.size();
  }

  /// After the run. Empty where it is another shard's.
  std::vector<ExampleRun> example() {
    if (!own_.has(0, {0, 0})) return {};
    complete_example();
    std::vector<ExampleRun> runs;
    for (auto& [estimator, run] : example_) runs.push_back(std::move(run));
    return runs;
  }

 private:
  std::vector<Task> tasks_to_do() const {
    const auto jobs = static_cast<std::size_t>(options_.jobs);
    if (store_ == nullptr) return tasks_of(study_, nullptr, data_sets_, own_, jobs);
    const RunIndex there(*store_);
    return tasks_of(study_, &there, data_sets_, own_, jobs);
  }

  std::size_t runs() const { return own_.count() * study_.description.estimators.size(); }

  // Where the system has no further thread fewer do the same work.
  void start_others(std::vector<std::jthread>& others, std::size_t count) {
    try {
      while (others.size() < count) others.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
    }
  }

  void work() {
    try {
      if (options_.on_thread_start) options_.on_thread_start();
      const auto meter = options_.make_meter ? options_.make_meter() : nullptr;
      for (std::size_t next = next_task_++; next < tasks_.size() && !watch_.is_stopped();
           next = next_task_++) {
        if (store_ == nullptr) {
          register_trial(tasks_[next]);
        } else {
          run_trial(tasks_[next], meter.get());
        }
      }
    } catch (const Stopped&) {
      // What is stored is whole.
    } catch (...) {
      const std::lock_guard hold(mutex_);
      if (!failure_) failure_ = std::current_exception();
      watch_.end();
    }
  }

  void register_trial(const Task& task) {
    const Configuration& configuration = study_.cells[task.cell];
    const std::shared_ptr<const Recorder> recorder = data_sets_.of(task.cell, task.survey);
    const bool is_own = configuration.study.association == Association::own;
    for (const std::size_t e : task.estimators) {
      if (watch_.is_stopped()) return;
      recorder->record(configuration,
                       is_own ? by_contender(configuration.estimators[e]) : configuration.reference,
                       registry_, noise_of(task),
                       watch_.over_front_end(data_sets_.shared(task.cell, task.survey)));
      if (!is_own) break;
    }
    data_sets_.trial_done(task.cell, task.survey);
    ++done_tasks_;
    watch_.registered(task.estimators.size());
  }

  void run_trial(const Task& task, MemoryMeter* meter) {
    const Configuration& configuration = study_.cells[task.cell];
    std::shared_ptr<const Recorder> recorder = data_sets_.of(task.cell, task.survey);
    const auto record_by = [&](const CandidateReference& reference) {
      return record_trial(*recorder, configuration, reference, registry_, noise_of(task),
                          watch_.over_front_end(data_sets_.shared(task.cell, task.survey)));
    };
    const auto judge_by_facts = [&](RecordedTrial& trial) {
      if (!task.estimators.empty()) trial.facts = study_facts(*trial.recording, registry_);
    };
    const bool is_own = configuration.study.association == Association::own;
    RecordedTrial trial;
    if (!is_own || task.estimators.empty()) {
      trial = record_by(configuration.reference);
      // Pictures and features are not held while solvers run that need none of them.
      recorder.reset();
      data_sets_.trial_done(task.cell, task.survey);
      judge_by_facts(trial);
      // Before all runs: beside one of them it would be in the caches of that one alone.
      if (task.baseline) add_baseline(task, *trial.recording);
    }
    for (const std::size_t e : task.estimators) {
      if (watch_.is_stopped()) return;
      if (is_own) {
        trial = record_by(by_contender(configuration.estimators[e]));
        judge_by_facts(trial);
      }
      // By the log of the first of the list, in whatever order they run.
      if (is_own && task.baseline && e == std::ranges::min(task.estimators)) {
        add_baseline(task, *trial.recording);
      }
      add_run(task, e, trial, meter);
    }
    if (recorder) data_sets_.trial_done(task.cell, task.survey);
    ++done_tasks_;
  }

  TrialNoise noise_of(const Task& task) const {
    return {survey_seed(study_.noise_seeds[task.cell], task.survey), task.trial};
  }

  void add_baseline(const Task& task, const Recording& recording) {
    RunRecord run = baseline_record(recording, study_.cells[task.cell].study.evaluation);
    run.key = task.run_of(kDeadReckoning);
    run.jobs = static_cast<int>(threads_);
    store_->add(run);
  }

  void add_run(const Task& task, std::size_t estimator, RecordedTrial& trial, MemoryMeter* meter) {
    const Configuration& configuration = study_.cells[task.cell];
    const EstimatorConfiguration& own = configuration.estimators[estimator];
    EvaluationOptions asked = evaluation_options(configuration, own);
    asked.memory = meter;
    asked.progress = watch_.over_run(own.name + " at keyframe");
    const JudgeOptions judging{.metrics = configuration.study.evaluation, .facts = &trial.facts};
    Result result = evaluate(*trial.recording, own, registry_, judging, asked);
    watch_.require_own_end(result);
    RunRecord run = run_record(*trial.recording, result, trial.facts.log_hash);
    run.key = task.run_of(own.name);
    run.jobs = static_cast<int>(threads_);
    store_->add(run);
    watch_.run_done(estimator, trial.lap_s(), !result.is_done());
    const std::lock_guard hold(mutex_);
    if (task.is_example()) example_[estimator] = {trial.recording, std::move(result)};
  }

  // What an earlier session stored of the example is replayed; its cost is that of the stored run.
  void complete_example() {
    const Configuration& configuration = study_.cells.front();
    const RunIndex stored(*store_);
    const bool is_own = configuration.study.association == Association::own;
    std::shared_ptr<const Recording> shared;
    if (!is_own && !example_.empty()) shared = example_.begin()->second.recording;
    for (std::size_t e = 0; e < configuration.estimators.size(); ++e) {
      if (example_.contains(e)) continue;
      if (is_own || !shared) {
        shared = record_trial(
                     *data_sets_.of(0, 0), configuration,
                     is_own ? by_contender(configuration.estimators[e]) : configuration.reference,
                     registry_, {study_.noise_seeds.front(), 0}, {})
                     .recording;
      }
      // Its metrics are stored: nothing is to be run without some of its loops.
      Recording with_all_loops = *shared;
      with_all_loops.is_held_out = {};
      const EstimatorConfiguration& estimator = configuration.estimators[e];
      const RunRecord& before = *stored.of(estimator.name, 0).at({0, 0});
      const auto lost = end_of_process(before.outcome);
      const JudgeOptions judging{.metrics = configuration.study.evaluation};
      EvaluationOptions again;
      again.isolation = configuration.isolation;
      Result result =
          lost ? evaluate_lost(*shared, estimator, registry_, judging, *lost, before.fault)
               : evaluate(with_all_loops, estimator, registry_, judging, again);
      result.metrics = before.metrics;
      example_[e] = {shared, std::move(result)};
    }
  }

  const Study& study_;
  const EstimatorRegistry& registry_;
  ResultStore* store_;
  const StudyRunOptions& options_;
  StudyDataSets data_sets_;
  ShardTrials own_;
  std::vector<Task> tasks_;
  std::size_t threads_;
  std::atomic<std::size_t> next_task_ = 0;
  std::atomic<std::size_t> done_tasks_ = 0;
  StudyWatch watch_;
  std::mutex mutex_;
  std::map<std::size_t, ExampleRun> example_;
  std::exception_ptr failure_;
};

}  // namespace

StudyRun run_study(const Study& study, const EstimatorRegistry& registry, ResultStore& store,
                   const StudyRunOptions& options) {
  Runner runner(study, registry, &store, options);
  if (!runner.run()) return {};
  return {true, runner.example()};
}

bool register_pictures(const Study& study, const EstimatorRegistry& registry,
                       const StudyRunOptions& options) {
  return Runner(study, registry, nullptr, options).run();
}

}  // namespace fathom
