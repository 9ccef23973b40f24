#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/candidates.hpp"
#include "fathom/front_end/estimated_sigmas.hpp"
#include "fathom/front_end/options.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// A keyframe as the front end hands it on.
struct Keyframe {
  std::size_t index = 0;  ///< among the keyframes
  std::size_t frame = 0;
  std::int64_t time_ns = 0;
  /// Dead reckoning from the keyframe before; absent at keyframe 0. A hole where the motion of one
  /// of its frames is.
  std::optional<RelativePose> step;
};

/// Where a frame is: so much further than its keyframe. The robot's pose at any frame is the last
/// keyframe's ⊕ the dead reckoning since.
struct FramePlace {
  std::int64_t time_ns = 0;
  std::size_t keyframe = 0;
  Pose motion_since_keyframe;
};

/// Least, median and most of a number over the keyframes.
struct Spread {
  double least = 0.0;
  double median = 0.0;
  double most = 0.0;
};

/// What the options came to on a survey.
struct FrontEndInMetres {
  Spread max_error_m;        ///< of a match, by the altitude of a picture
  Spread reach_m;            ///< of candidates, as estimated, between pictures from one altitude
  Spread step_m;             ///< between keyframes, by dead reckoning
  Spread separation_frames;  ///< likewise
};

/// The altitude of every keyframe, and how far each but the first is from the one before.
struct KeyframeLengths {
  std::vector<double> altitudes_m;
  std::vector<double> steps_m;
  std::vector<double> separation_frames;
};

/// Of two keyframes at least. Throws InputError as CandidateOptions::check.
FrontEndInMetres in_metres(const FrontEndOptions& options, const Camera& camera,
                           KeyframeLengths keyframes);

/// Turns frames into keyframe events: the paper's section 2. Use:
///
///     while (auto keyframe = front_end.next_keyframe()) {
///       if (keyframe->step) estimator.add_keyframe(*keyframe->step);
///       estimator.update({front_end.register_newest(estimator)});
///     }
///
/// A registration that fails never stops the run: dead reckoning carries it.
class FrontEnd {
 public:
  /// Source and registrar must outlive it; the registrar must be of the same pictures. Of the
  /// options it takes keyframes and candidates; how pairs register is the registrar's. The source
  /// must have odometry (VisualOdometry gives it to one that has none); throws InputError
  /// otherwise.
  FrontEnd(const FrameSource& source, PairRegistrar& registrar, const FrontEndOptions& options,
           const EstimatedSigmas& sigmas = {});

  /// The next keyframe, by KeyframeSchedule. Nothing at the end.
  std::optional<Keyframe> next_keyframe();

  /// Registers the newest keyframe with every candidate (CandidateSearch) of the given trajectory,
  /// which must hold all keyframes so far. What was found, by rising `from`. Where the keyframe
  /// before is the frame before and dead reckoning is visual odometry, it is no candidate: its
  /// registration is the step already, and no measurement may count twice.
  std::vector<RelativePose> register_newest(const TrajectoryView& trajectory);

  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  /// Of all frames passed so far, the ones after the last keyframe included.
  const std::vector<FramePlace>& frames() const { return frames_; }
  /// Of the keyframes so far, two at least.
  FrontEndInMetres in_metres() const;
  std::size_t registrations_tried() const { return tried_; }
  /// Of those not found: most matches that agreed with a motion.
  int most_refused_inliers() const { return most_refused_inliers_; }
  std::size_t registrations_found() const { return found_; }
  /// Candidates beyond what a keyframe may have.
  std::size_t registrations_left_out() const { return left_out_; }
  /// Keyframes, rising, whose candidates asked the trajectory for covariances.
  const std::vector<std::size_t>& asked_covariances() const { return asked_covariances_; }

 private:
  Keyframe add_keyframe(std::size_t frame, const FrameInfo& info, const UncertainPose& since,
                        bool over_hole);
  Candidates candidates(const TrajectoryView& trajectory);
  /// The newest keyframe with each of them, where a registration is found.
  std::vector<RelativePose> registered(const Candidates& candidates);
  MeasuredFrame measured(std::size_t frame) const;
  void announce_next_keyframes();

  const FrameSource& source_;
  PairRegistrar& registrar_;
  FrontEndOptions options_;
  EstimatedSigmas sigmas_;
  CandidateSearch search_;
  KeyframeSchedule schedule_;
  std::vector<Keyframe> keyframes_;
  std::vector<Stance> stances_;     ///< of the keyframes
  std::vector<std::size_t> holes_;  ///< keyframes that a hole leads to
  std::vector<std::size_t> asked_covariances_;
  std::vector<FramePlace> frames_;
  std::size_t tried_ = 0;
  std::size_t found_ = 0;
  int most_refused_inliers_ = 0;
  std::size_t left_out_ = 0;
};

}  // namespace fathom
