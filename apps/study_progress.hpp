#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

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
  std::string pace(const StudyProgress& progress, Clock::time_point now) const;

  bool quiet_;
  bool is_terminal_;
  bool shown_ = false;
  std::optional<std::pair<Clock::time_point, std::size_t>> first_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace fathom
