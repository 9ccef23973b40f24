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
  const double since_s = std::chrono::duration<double>(now - last_).count();
  const double wait_s = is_terminal_ ? (shown_ ? 0.2 : 0.0) : 30.0;
  if (quiet_ || since_s < wait_s) return;
  last_ = now;
  shown_ = true;
  std::fprintf(stderr, "%s%zu of %zu runs, %zu failed%s%s%s", is_terminal_ ? "\r\033[K" : "",
               progress.done, progress.of, progress.failed, left(progress).c_str(),
               stage(progress).c_str(), is_terminal_ ? "" : "\n");
}

std::string StudyProgressLine::stage(const StudyProgress& progress) {
  if (progress.stage.empty()) return "";
  std::string text = "; " + progress.stage + " " + std::to_string(progress.step) + " of " +
                     std::to_string(progress.steps);
  if (progress.pairs) text += ", " + pairs_text(*progress.pairs, progress.of_pairs);
  return text;
}

std::string StudyProgressLine::left(const StudyProgress& progress) {
  if (!progress.left_s) return "";
  return (progress.left_is_least ? ", at least " : ", ") + duration_text(*progress.left_s) +
         " left";
}

}  // namespace fathom
