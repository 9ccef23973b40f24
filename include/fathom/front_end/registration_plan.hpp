#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/front_end.hpp"
#include "fathom/front_end/options.hpp"

namespace fathom {

/// Two keyframes that may close a loop, and what dead reckoning says of the heading between them.
struct ReckonedLoop {
  double sigma_rad = 0.0;
  double way_m = 0.0;
};

/// What the front end will try on a survey, as far as dead reckoning tells before any picture is
/// registered: with its poses for the estimate, and without covariances.
struct RegistrationPlan {
  /// By keyframe: how many earlier ones it will be registered with.
  std::vector<std::size_t> candidates;
  std::size_t consecutive = 0;  ///< of all candidates, those one keyframe before
  KeyframeLengths lengths;
  /// Of the pairs that are not consecutive, over no hole: the one whose heading is known worst.
  std::optional<ReckonedLoop> widest;
  /// The pair that will be tried last, if there is one.
  std::optional<std::pair<MeasuredFrame, MeasuredFrame>> last_pair;

  std::size_t all_candidates() const;
};

/// Asks the source for the motion and altitude of every frame, in order. It must have odometry that
/// costs nothing to ask for: not that of visual odometry. Throws InputError as
/// CandidateOptions::check.
RegistrationPlan plan_registrations(const FrameSource& frames, const FrontEndOptions& options);

}  // namespace fathom
