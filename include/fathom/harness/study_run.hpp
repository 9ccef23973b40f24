#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_cache.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/shard.hpp"

namespace fathom {

/// How far a study has come. A run is one estimator on one trial of one cell.
struct StudyProgress {
  std::size_t done = 0;     ///< runs, those of earlier sessions included
  std::size_t earlier = 0;  ///< of them, those that were there already
  std::size_t of = 0;
  std::size_t failed = 0;  ///< of this session's runs: diverged or numerical failure
  /// What the trial last heard of is at: "front end at picture", or an estimator "at keyframe".
  std::string stage;
  std::size_t step = 0;
  std::size_t steps = 0;
  /// Of the front end: pairs of pictures tried, of about how many (FrontEndProgress).
  std::optional<std::size_t> pairs;
  std::optional<std::size_t> of_pairs;
  /// Of this session's runs and registrations. Absent as long as nothing tells.
  std::optional<double> left_s;
  bool left_is_least = false;  ///< of a part nothing tells yet, so more is left
};

struct StudyRunOptions {
  Shard shard;  ///< the part of the study that is run; all of it if not given
  /// In place of a shard: the first trial of the first survey of this cell alone.
  std::optional<std::size_t> sample;
  int jobs = 1;  ///< trials at work at the same time, at most
  RegistrationCache* registrations = nullptr;
  /// A meter for the thread that calls; none: memory is not measured.
  std::function<std::unique_ptr<MemoryMeter>()> make_meter;
  /// Called on every thread before its first trial: pins the threads of BLAS and the like.
  std::function<void()> on_thread_start;
  /// Called after every run, and every second or so during one that takes longer; by one thread at
  /// a time.
  std::function<void(const StudyProgress&)> progress;
  /// Set by somebody else to end the study: trials at work are left at their next keyframe. What is
  /// stored stays, and so do the registrations.
  const std::atomic<bool>* stop = nullptr;
};

/// Every file of the data sets of a study's cells with the hash of its content, each data set
/// opened once. Throws InputError.
Fingerprint data_of(const Study& study);

/// Trials of all cells and surveys.
std::size_t trials_in_all(const Study& study);

/// What is a shard's, done or not.
ShardPlan plan_of(const Study& study, const Shard& shard, const std::string& command_line);

/// Jobs that can be at work: no more than there are trials.
int jobs_of(const Study& study);

/// One estimator's run with all that it was made of.
struct ExampleRun {
  std::shared_ptr<const Recording> recording;  ///< one for all where the estimators share it
  Result result;
};

struct StudyRun {
  bool is_finished = false;  ///< false where it was stopped before the end
  /// Survey 0, trial 0 of the first cell as it was stored, by estimator; empty if not finished, or
  /// where it is another shard's.
  std::vector<ExampleRun> example;
};

/// Runs what of a study is not yet in its store: every estimator on every trial of every survey of
/// every cell, and dead reckoning beside them. What is stored does not depend on the number of
/// jobs, nor on the order or on what was there before, cost apart. Runs of the example that an
/// earlier session stored are replayed, and keep their stored metrics. Throws InputError where the
/// data set or the store fails; what is stored stays.
StudyRun run_study(const Study& study, const EstimatorRegistry& registry, ResultStore& store,
                   const StudyRunOptions& options);

/// Registers the pictures that a study's trials need, into `options.registrations`; no estimator
/// runs but those that select loop candidates. False where it was stopped before the end.
bool register_pictures(const Study& study, const EstimatorRegistry& registry,
                       const StudyRunOptions& options);

}  // namespace fathom
