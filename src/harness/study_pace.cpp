#include "study_pace.hpp"

#include <algorithm>

namespace fathom {

/// Of times, some of which are not known.
class StudyPace::Sum {
 public:
  void add(std::optional<double> seconds, std::size_t times = 1) {
    if (times == 0) return;
    if (seconds) {
      seconds_ += *seconds * static_cast<double>(times);
      longest_s_ = std::max(longest_s_, *seconds);
      is_known_ = true;
    } else {
      lacks_ = true;
    }
  }

  void lack() { lacks_ = true; }
  /// A pass or a run has one thread, so that the longest of them bounds all.
  std::optional<Left> over(std::size_t threads) const {
    if (!is_known_ && lacks_) return std::nullopt;
    return Left{std::max(seconds_ / static_cast<double>(threads), longest_s_), lacks_};
  }

 private:
  double seconds_ = 0.0;
  double longest_s_ = 0.0;
  bool is_known_ = false;
  bool lacks_ = false;
};

// A survey that was registered in part before it was stopped says what a whole one takes, if what
// it took is of registering and not of all else.
std::optional<double> StudyPace::Pass::all_s() const {
  constexpr double kLeastAnew = 0.2;
  if (!progress.left_s || progress.anew < kLeastAnew) return std::nullopt;
  return (elapsed_s + *progress.left_s) / progress.anew;
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
  if (!at->second.is_first) {
    later_.add(elapsed_s);
  } else if (const auto all_s = at->second.all_s()) {
    first_.add(*all_s);
  } else {
    known_.add(elapsed_s);
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

std::optional<double> StudyPace::left_of(const Pass& pass) const {
  const Mean& alike = pass.is_first ? first_ : later_;
  const bool is_told = pass.progress.left_s && (pass.is_first || alike.count == 0);
  if (is_told || alike.count == 0) return pass.progress.left_s;
  return std::max(0.0, *alike.value() - pass.elapsed_s);
}

void StudyPace::add_front_ends(Sum& sum) const {
  for (const auto& [number, pass] : at_work_) sum.add(left_of(pass));
  for (const auto& [survey, passes] : to_do_.front_ends) {
    const auto begun = begun_.find(survey);
    const std::size_t done = begun == begun_.end() ? 0 : begun->second;
    if (done >= passes) continue;
    const std::size_t first = done == 0 ? 1 : 0;
    const auto anew_s = first_pass().value();
    sum.add(anew_s ? anew_s : known_.value(), first);
    // All surveys so far were known; the next may not be.
    if (first > 0 && !anew_s) sum.lack();
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
