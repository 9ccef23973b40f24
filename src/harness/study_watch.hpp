#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <utility>

#include "fathom/harness/study_run.hpp"

namespace fathom {

/// Leaves a trial in the middle.
struct Stopped {};

/// Says how far a study has come, and whether somebody asked it to stop. May be used from several
/// threads at once.
class StudyWatch {
 public:
  /// The options must outlive it.
  StudyWatch(const StudyRunOptions& options, std::size_t done, std::size_t of) : options_(options) {
    progress_.earlier = progress_.done = done;
    progress_.of = of;
  }

  bool is_stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  void runs_done(std::size_t runs, std::size_t failed) {
    const std::lock_guard hold(mutex_);
    progress_.done += runs;
    progress_.failed += failed;
    if (options_.progress) options_.progress(progress_);
  }

  /// For a part of a trial that calls it at every step. Throws Stopped.
  Progress over(std::string stage) {
    return [this, stage = std::move(stage)](std::size_t step, std::size_t steps) {
      if (is_stopped()) throw Stopped{};
      const std::lock_guard hold(mutex_);
      const auto now = Clock::now();
      if (now - heard_ < std::chrono::seconds(1)) return;
      heard_ = now;
      progress_.stage = stage;
      progress_.step = step;
      progress_.steps = steps;
      if (options_.progress) options_.progress(progress_);
    };
  }

 private:
  using Clock = std::chrono::steady_clock;

  const StudyRunOptions& options_;
  std::mutex mutex_;
  StudyProgress progress_;
  Clock::time_point heard_ = Clock::now();
};

}  // namespace fathom
