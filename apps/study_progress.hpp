#pragma once

#include <chrono>
#include <string>

#include "fathom/harness/study_run.hpp"

namespace fathom {

/// How far a study has come: on the terminal one line that changes, elsewhere a line now and then.
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

  bool quiet_;
  bool is_terminal_;
  bool shown_ = false;
  Clock::time_point last_ = Clock::now();
};

}  // namespace fathom
