#include "fathom/harness/study_pace.hpp"

#include <algorithm>

namespace fathom {

/// Of times, some of which are not known.
class StudyPace::Sum {
 public:
  void add(std::optional<double> seconds, std::size_t times = 1) {
    if (times == 0) return;
    if (seconds) {
      seconds_ += *seconds * static_cast<double>(times);
      is_known_ = true;
    } else {
      lacks_ = true;
    }
  }

  std::optional<Left> over(std::size_t threads) const {
    if (!is_known_ && lacks_) return std::nullopt;
    return Left{seconds_ / static_cast<double>(threads), lacks_};
  }

 private:
  double seconds_ = 0.0;
  bool is_known_ = false;
  bool lacks_ = false;
};

// A survey that was registered in part before it was stopped says what a whole one takes.
std::optional<double> StudyPace::Pass::all_s() const {
  if (!progress.left_s) return std::nullopt;
  const double s = elapsed_s + *progress.left_s;
  return progress.anew > 0.0 ? s / progress.anew : s;
}

std::size_t StudyPace::begin_front_end(const SharedSurvey& survey) {
  at_work_[passes_].is_first = begun_[survey]++ == 0;
  return passes_++;
}

void StudyPace::front_end_at(std::size_t pass, double elapsed_s, const FrontEndProgress& progress) {
  const auto at = at_work_.find(pass);
  if (at == at_work_.end()) return;
  at->second.elapsed_s = elapsed_s;
  at->second.progress = progress;
  if (!progress.is_done()) return;
  if (at->second.is_first) {
    first_.add(at->second.all_s().value_or(elapsed_s));
  } else {
    later_.add(elapsed_s);
  }
  at_work_.erase(at);
}

void StudyPace::run_done(std::size_t estimator, double seconds) {
  runs_[estimator].add(seconds);
  std::size_t& left = to_do_.runs[estimator];
  if (left > 0) --left;
}

// By those that are done, else by those at work.
StudyPace::Mean StudyPace::first_pass() const {
  if (first_.count > 0) return first_;
  Mean expected;
  for (const auto& [number, pass] : at_work_) {
    if (!pass.is_first) continue;
    if (const auto all_s = pass.all_s()) expected.add(*all_s);
  }
  return expected;
}

void StudyPace::add_front_ends(Sum& sum) const {
  for (const auto& [number, pass] : at_work_) {
    std::optional<double> left_s = pass.progress.left_s;
    if (!left_s) {
      left_s = (pass.is_first ? first_ : later_).value();
      if (left_s) left_s = std::max(0.0, *left_s - pass.elapsed_s);
    }
    sum.add(left_s);
  }
  for (const auto& [survey, passes] : to_do_.front_ends) {
    const auto begun = begun_.find(survey);
    const std::size_t done = begun == begun_.end() ? 0 : begun->second;
    if (done >= passes) continue;
    const std::size_t first = done == 0 ? 1 : 0;
    sum.add(first_pass().value(), first);
    sum.add(later_.value(), passes - done - first);
  }
}

std::optional<StudyPace::Left> StudyPace::left() const {
  Sum sum;
  add_front_ends(sum);
  for (const auto& [estimator, count] : to_do_.runs) {
    const auto known = runs_.find(estimator);
    sum.add(known == runs_.end() ? std::nullopt : known->second.value(), count);
  }
  return sum.over(threads_);
}

}  // namespace fathom
