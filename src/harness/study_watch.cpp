#include "study_watch.hpp"

#include <utility>

#include "fathom/harness/isolated_replay.hpp"

namespace fathom {

StudyWatch::StudyWatch(const StudyRunOptions& options, std::size_t done, std::size_t of,
                       StudyPace pace)
    : options_(options), pace_(std::move(pace)) {
  progress_.earlier = progress_.done = done;
  progress_.of = of;
}

bool StudyWatch::is_due() {
  const auto now = Clock::now();
  if (now - heard_ < std::chrono::seconds(1)) return false;
  heard_ = now;
  return true;
}

void StudyWatch::say() {
  const auto left = pace_.left();
  progress_.left_s = left ? std::optional(left->seconds) : std::nullopt;
  progress_.left_is_least = left && left->is_least;
  if (options_.progress) options_.progress(progress_);
}

void StudyWatch::require_own_end(const Result& result) const {
  if (is_stopped() && end_of_process(name_of(result.run.outcome))) throw Stopped{};
}

void StudyWatch::run_done(std::size_t estimator, double seconds, bool is_failed) {
  const std::lock_guard hold(mutex_);
  pace_.run_done(estimator, seconds);
  ++progress_.done;
  progress_.failed += is_failed ? 1 : 0;
  say();
}

void StudyWatch::registered(std::size_t runs) {
  const std::lock_guard hold(mutex_);
  progress_.done += runs;
  say();
}

FrontEndProgressCallback StudyWatch::over_front_end(const SharedSurvey& survey) {
  // A graph has no front end, and never calls.
  std::optional<std::size_t> pass;
  return [this, survey, pass, start = Clock::now()](const FrontEndProgress& at) mutable {
    if (is_stopped()) throw Stopped{};
    const std::lock_guard hold(mutex_);
    const auto now = Clock::now();
    if (!pass) pass = pace_.begin_front_end(survey);
    pace_.front_end_at(*pass, std::chrono::duration<double>(now - start).count(), at);
    // That a survey is begun is said at once: its first picture may take long.
    if (!is_due() && at.pictures > 0) return;
    progress_.stage = "front end at picture";
    progress_.step = at.pictures;
    progress_.steps = at.of_pictures;
    progress_.pairs = at.pairs;
    progress_.of_pairs = at.of_pairs;
    say();
  };
}

Progress StudyWatch::over_run(std::string stage) {
  return [this, stage = std::move(stage)](std::size_t step, std::size_t steps) {
    if (is_stopped()) throw Stopped{};
    const std::lock_guard hold(mutex_);
    if (!is_due()) return;
    progress_.stage = stage;
    progress_.step = step;
    progress_.steps = steps;
    progress_.pairs.reset();
    progress_.of_pairs.reset();
    say();
  };
}

}  // namespace fathom
