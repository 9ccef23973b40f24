#include "fathom/harness/front_end_pace.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom {
namespace {

// The first pictures wait for what is made once, such as a simulated floor; they tell nothing of
// the others.
constexpr std::size_t kFirstKeyframes = 2;

}  // namespace

FrontEndPace::FrontEndPace(const FrameSource& frames, PairRegistrar& registrar,
                           const FrontEndOptions& options)
    : frames_(frames), registrar_(registrar), registered_before_(registrar.registered()) {
  if (!frames.is_visual_odometry()) plan_ = plan_registrations(frames, options);
}

FrontEndProgress FrontEndPace::at(const FrontEnd& front_end) {
  // What was known took no time to speak of.
  const bool is_first_work = !has_worked_ && registrar_.registered() == registered_before_;
  has_worked_ = has_worked_ || !is_first_work;
  if (front_end.keyframes().size() <= kFirstKeyframes || is_first_work) {
    start_ = Clock::now();
    pictures_at_start_ = Work::of(registrar_.work_on_pictures());
    pairs_at_start_ = Work::of(registrar_.work_on_pairs());
  }
  FrontEndProgress progress;
  progress.pictures = front_end.frames().size();
  progress.of_pictures = frames_.size();
  progress.pairs = front_end.registrations_tried();
  if (plan_) {
    progress.of_pairs =
        progress.pairs + static_cast<std::size_t>(std::lround(pairs_left(front_end)));
  }
  progress.left_s = left_s(front_end);
  const auto anew = static_cast<double>(registrar_.registered() - registered_before_);
  const auto tried = static_cast<double>(std::max<std::size_t>(progress.pairs, 1));
  progress.anew = std::min(1.0, anew / tried);
  return progress;
}

// The estimate has drifted otherwise than dead reckoning, and knows of more that may overlap: what
// the plan still promises is scaled by what came of it so far.
double FrontEndPace::pairs_left(const FrontEnd& front_end) const {
  const auto passed =
      plan_->candidates.begin() + static_cast<std::ptrdiff_t>(front_end.keyframes().size());
  const auto planned = std::accumulate(plan_->candidates.begin(), passed, std::size_t{0});
  // So that the first few say little.
  constexpr double kOneKeyframe = 10.0;
  const double scale = (static_cast<double>(front_end.registrations_tried()) + kOneKeyframe) /
                       (static_cast<double>(planned) + kOneKeyframe);
  return scale * static_cast<double>(plan_->all_candidates() - planned);
}

bool FrontEndPace::is_all_known() {
  if (!is_all_known_) {
    is_all_known_ = plan_ && plan_->last_pair &&
                    registrar_.is_known(plan_->last_pair->first, plan_->last_pair->second);
  }
  return *is_all_known_;
}

// By the share of pictures, where nothing better tells. Pictures and pairs that are made anew go by
// what those before them took: threads' time, scaled to what passed.
std::optional<double> FrontEndPace::left_s(const FrontEnd& front_end) {
  const std::size_t keyframes = front_end.keyframes().size();
  if (front_end.frames().size() == frames_.size()) return 0.0;
  if (keyframes <= kFirstKeyframes + 1) return std::nullopt;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  const Work pictures = Work::of(registrar_.work_on_pictures()).since(pictures_at_start_);
  const Work pairs = Work::of(registrar_.work_on_pairs()).since(pairs_at_start_);
  const double done_s = pictures.seconds + pairs.seconds;
  if (!plan_ || (done_s <= 0.0 && is_all_known())) {
    const auto passed = static_cast<double>(front_end.frames().size());
    return std::chrono::duration<double>(Clock::now() - begin_).count() *
           (static_cast<double>(frames_.size()) - passed) / passed;
  }
  // Where what comes is not known, all that was known tells nothing of its time.
  if (done_s <= 0.0) return std::nullopt;
  const auto keyframes_left = static_cast<double>(plan_->candidates.size() - keyframes);
  const double left_s = keyframes_left * pictures.mean_s() + pairs_left(front_end) * pairs.mean_s();
  return left_s * elapsed_s / done_s;
}

}  // namespace fathom
