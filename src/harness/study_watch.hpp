#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "fathom/harness/result.hpp"
#include "fathom/harness/study_run.hpp"
#include "study_pace.hpp"

namespace fathom {

/// Leaves a trial in the middle.
struct Stopped {};

/// Says how far a study has come and what is left, and whether somebody asked it to stop. May be
/// used from several threads at once.
class StudyWatch {
 public:
  /// The options must outlive it. `done` runs of `of` were there before.
  StudyWatch(const StudyRunOptions& options, std::size_t done, std::size_t of, StudyPace pace);

  bool is_stopped() const {
    return is_ended_ || (options_.stop != nullptr && options_.stop->load());
  }

  /// One thread cannot go on, so that the study will not be finished: the others are stopped, too.
  void end() { is_ended_ = true; }

  /// To be asked before a run is stored. Throws Stopped where its process, or the program that it
  /// called, was lost once a stop was asked for: the same signal may have ended it.
  void require_own_end(const Result& result) const;

  /// A run that took so long, with what was computed for it alone.
  void run_done(std::size_t estimator, double seconds, bool is_failed);
  /// Runs that were only prepared.
  void registered(std::size_t runs);

  /// For a pass of the front end over a survey's pictures. What it returns throws Stopped.
  FrontEndProgressCallback over_front_end(const SharedSurvey& survey);
  /// For an estimator's run. What it returns throws Stopped.
  Progress over_run(std::string stage);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due();
  void say();

  const StudyRunOptions& options_;
  std::atomic<bool> is_ended_ = false;
  std::mutex mutex_;
  StudyPace pace_;
  StudyProgress progress_;
  Clock::time_point heard_ = Clock::now();
};

}  // namespace fathom
