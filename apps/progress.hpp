#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "fathom/harness/front_end_pace.hpp"
#include "fathom/harness/study_run.hpp"

namespace fathom {

/// Whether standard error is a terminal.
bool is_error_terminal();

/// Progress on the terminal with an estimate of what is left; silent when quiet or when standard
/// error is no terminal.
class ProgressLine {
 public:
  ProgressLine(std::string what, bool quiet);
  /// Leaves an empty line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  const std::string& what() const { return what_; }
  void show(std::size_t done, std::size_t of);
  void show(const FrontEndProgress& at);

 private:
  bool is_due(bool is_last);

  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool shown_ = false;
  bool enabled_;
  /// When so many were done for the first time.
  std::optional<std::pair<Clock::time_point, std::size_t>> first_;
  Clock::time_point last_ = Clock::now();
};

/// How far a study has come, in one line that changes; silent as ProgressLine is.
class StudyProgressLine {
 public:
  explicit StudyProgressLine(bool quiet);
  ~StudyProgressLine();
  StudyProgressLine(const StudyProgressLine&) = delete;
  StudyProgressLine& operator=(const StudyProgressLine&) = delete;

  void show(const StudyProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  static std::string stage(const StudyProgress& progress);
  static std::string left(const StudyProgress& progress);

  bool enabled_;
  bool shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace fathom
