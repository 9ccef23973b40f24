#include "apps/progress.hpp"

#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

namespace fathom {
namespace {

// "95 s", "12 min", "13.4 h".
std::string duration_text(double seconds) {
  char text[64];
  // Rounded by less than a tenth.
  if (seconds < 600.0) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 36000.0) {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60.0);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600.0);
  }
  return text;
}

// Of what a front end has tried: "pair 310 of about 1405".
std::string pairs_text(std::size_t pairs, const std::optional<std::size_t>& of_pairs) {
  const std::string text = "pair " + std::to_string(pairs);
  return of_pairs ? text + " of about " + std::to_string(*of_pairs) : text;
}

}  // namespace

bool is_error_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

ProgressLine::ProgressLine(std::string what, bool quiet)
    : what_(std::move(what)), enabled_(!quiet && is_error_terminal()) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(const FrontEndProgress& at) {
  if (!enabled_ || !is_due(at.is_done())) return;
  const std::string left = at.left_s ? ", " + duration_text(*at.left_s) + " left" : "";
  std::fprintf(stderr, "\r\033[K%s: %zu of %zu, %s%s", what_.c_str(), at.pictures, at.of_pictures,
               pairs_text(at.pairs, at.of_pairs).c_str(), left.c_str());
}

bool ProgressLine::is_due(bool is_last) {
  const auto now = Clock::now();
  if (shown_ && !is_last && now - last_ < std::chrono::milliseconds(200)) return false;
  last_ = now;
  shown_ = true;
  return true;
}

// The first one may have waited for what all need.
void ProgressLine::show(std::size_t done, std::size_t of) {
  if (!enabled_) return;
  if (!first_ && done > 0) first_ = {Clock::now(), done};
  if (!is_due(done == of)) return;
  std::string left;
  if (first_ && done > first_->second) {
    const std::chrono::duration<double> elapsed = last_ - first_->first;
    left = ", " +
           duration_text(elapsed.count() * static_cast<double>(of - done) /
                         static_cast<double>(done - first_->second)) +
           " left";
  }
  std::fprintf(stderr, "\r\033[K%s: %zu of %zu%s", what_.c_str(), done, of, left.c_str());
}

StudyProgressLine::StudyProgressLine(bool quiet) : enabled_(!quiet && is_error_terminal()) {}

StudyProgressLine::~StudyProgressLine() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

void StudyProgressLine::show(const StudyProgress& progress) {
  const auto now = Clock::now();
  const double since_s = std::chrono::duration<double>(now - last_).count();
  if (!enabled_ || (shown_ && since_s < 0.2)) return;
  last_ = now;
  shown_ = true;
  std::fprintf(stderr, "\r\033[K%zu of %zu runs, %zu failed%s%s", progress.done, progress.of,
               progress.failed, left(progress).c_str(), stage(progress).c_str());
}

std::string StudyProgressLine::stage(const StudyProgress& progress) {
  if (progress.stage.empty()) return "";
  std::string text = fmt::format("; {} {} of {}", progress.stage, progress.step, progress.steps);
  if (progress.pairs) text += ", " + pairs_text(*progress.pairs, progress.of_pairs);
  return text;
}

std::string StudyProgressLine::left(const StudyProgress& progress) {
  if (!progress.left_s) return "";
  return (progress.left_is_least ? ", at least " : ", ") + duration_text(*progress.left_s) +
         " left";
}

}  // namespace fathom
