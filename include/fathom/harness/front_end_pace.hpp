#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>

#include "fathom/front_end/front_end.hpp"
#include "fathom/front_end/registration_plan.hpp"

namespace fathom {

/// How far the front end has come on a survey.
struct FrontEndProgress {
  std::size_t pictures = 0;  ///< passed
  std::size_t of_pictures = 0;
  std::size_t pairs = 0;  ///< of pictures, that it tried to register
  /// About, by dead reckoning; absent where that is visual odometry.
  std::optional<std::size_t> of_pairs;
  /// Absent as long as nothing tells.
  std::optional<double> left_s;
  /// The share of the work that was done anew: 0 where all was known, from a cache or from other
  /// trials.
  double anew = 0.0;

  bool is_done() const { return pictures == of_pictures; }
};

using FrontEndProgressCallback = std::function<void(const FrontEndProgress&)>;

/// Tells how far a front end has come and what time is left, by what its pictures and pairs took so
/// far and how many pairs dead reckoning promises.
class FrontEndPace {
 public:
  /// Plans the registrations, but for visual odometry. All must outlive it.
  FrontEndPace(const FrameSource& frames, PairRegistrar& registrar, const FrontEndOptions& options);

  /// To be called after every keyframe.
  FrontEndProgress at(const FrontEnd& front_end);

 private:
  using Clock = std::chrono::steady_clock;
  /// Of the work of one kind.
  struct Work {
    std::size_t count = 0;
    double seconds = 0.0;

    static Work of(const WorkMeter& meter) { return {meter.count(), meter.seconds()}; }
    Work since(const Work& start) const { return {count - start.count, seconds - start.seconds}; }
    double mean_s() const { return count == 0 ? 0.0 : seconds / static_cast<double>(count); }
  };

  bool is_all_known();
  double pairs_left(const FrontEnd& front_end) const;
  std::optional<double> left_s(const FrontEnd& front_end);

  const FrameSource& frames_;
  PairRegistrar& registrar_;
  std::optional<RegistrationPlan> plan_;
  std::optional<bool> is_all_known_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point start_ = begin_;  ///< from which on work is measured
  bool has_worked_ = false;           ///< that a pair was registered anew
  Work pictures_at_start_;
  Work pairs_at_start_;
  std::size_t registered_before_;  ///< pairs
};

}  // namespace fathom
