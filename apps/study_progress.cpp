#include "apps/study_progress.hpp"

#include <cstdio>

#include "apps/common.hpp"

namespace fathom {

StudyProgressLine::StudyProgressLine(bool quiet)
    : quiet_(quiet), is_terminal_(is_error_terminal()) {}

StudyProgressLine::~StudyProgressLine() {
  if (shown_ && is_terminal_) std::fprintf(stderr, "\r\033[K");
}

void StudyProgressLine::show(const StudyProgress& progress) {
  const auto now = Clock::now();
  if (!first_) first_ = {now, progress.done};
  const double since_s = std::chrono::duration<double>(now - last_).count();
  if (quiet_ || since_s < (is_terminal_ ? 0.2 : 30.0)) return;
  last_ = now;
  shown_ = true;
  std::fprintf(stderr, "%s%zu of %zu runs%s, %zu failed%s%s", is_terminal_ ? "\r\033[K" : "",
               progress.done, progress.of, pace(progress, now).c_str(), progress.failed,
               stage(progress).c_str(), is_terminal_ ? "" : "\n");
}

std::string StudyProgressLine::stage(const StudyProgress& progress) {
  if (progress.stage.empty()) return "";
  return ", " + progress.stage + " " + std::to_string(progress.step) + " of " +
         std::to_string(progress.steps);
}

// From the second run on: the first one waits for most of the registrations.
std::string StudyProgressLine::pace(const StudyProgress& progress, Clock::time_point now) const {
  const double elapsed_s = std::chrono::duration<double>(now - first_->first).count();
  if (progress.done == first_->second || elapsed_s <= 0.0) return "";
  const double rate = static_cast<double>(progress.done - first_->second) / elapsed_s;
  const double left_s = static_cast<double>(progress.of - progress.done) / rate;
  char text[64];
  std::snprintf(text, sizeof text, ", %.1f runs/s, %.0f s left", rate, left_s);
  return text;
}

}  // namespace fathom
