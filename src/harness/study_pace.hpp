#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "fathom/harness/front_end_pace.hpp"

namespace fathom {

/// The pictures that trials share: the first cell that has them, and the survey.
using SharedSurvey = std::pair<std::size_t, std::size_t>;

/// What a session of a study has to do.
struct StudyWork {
  std::map<SharedSurvey, std::size_t> front_ends;  ///< passes over a survey's pictures
  std::map<std::size_t, std::size_t> runs;         ///< by estimator
};

/// What is left of a study, by what its parts took so far: the first pass over a survey, which
/// registers its pictures, those after it, and the runs of each estimator. It has no clock; times
/// are a thread's, in seconds. Not for several threads at once.
class StudyPace {
 public:
  StudyPace(StudyWork to_do, std::size_t threads) : to_do_(std::move(to_do)), threads_(threads) {}

  /// The number of the pass.
  std::size_t begin_front_end(const SharedSurvey& survey);
  void front_end_at(std::size_t pass, double elapsed_s, const FrontEndProgress& progress);
  void run_done(std::size_t estimator, double seconds);

  struct Left {
    double seconds = 0.0;
    bool is_least = false;  ///< a part of it is not known yet
  };
  /// Nothing as long as nothing is known.
  std::optional<Left> left() const;

 private:
  struct Mean {
    double sum = 0.0;
    std::size_t count = 0;

    void add(double value) {
      sum += value;
      ++count;
    }
    std::optional<double> value() const {
      return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
    }
  };
  struct Pass {
    bool is_first = false;
    double elapsed_s = 0.0;
    FrontEndProgress progress;

    std::optional<double> all_s() const;
  };
  class Sum;

  Mean first_pass() const;
  std::optional<double> left_of(const Pass& pass) const;
  void add_front_ends(Sum& sum) const;

  StudyWork to_do_;
  std::size_t threads_;
  std::map<SharedSurvey, std::size_t> begun_;
  std::size_t passes_ = 0;
  std::map<std::size_t, Pass> at_work_;
  Mean first_;  ///< of first passes that are done, as if they had found nothing known
  Mean known_;  ///< of first passes that found all known, or nearly all
  Mean later_;
  std::map<std::size_t, Mean> runs_;
};

}  // namespace fathom
