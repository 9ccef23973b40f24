#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>

#include "fathom/core/random.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/front_end/estimated_sigmas.hpp"
#include "fathom/front_end/options.hpp"
#include "fathom/front_end/pair_registrar.hpp"

namespace fathom {

/// A survey whose dead reckoning is the registration of each frame with the one before. The
/// covariance of a motion is the registration's plus that of the added noise. Where consecutive
/// pictures do not register, the last motion is repeated with the fallback's uncertainty.
///
/// Motions are made when first asked for, in order, so ask in rising order; `info` is for one
/// thread, `image` for several.
class VisualOdometry : public FrameSource {
 public:
  /// The source and the registrar, which must be of the same pictures, must outlive this. Draws of
  /// the noise come from the stream "visual_odometry".
  VisualOdometry(const FrameSource& source, PairRegistrar& registrar,
                 const VisualOdometryFallback& fallback, const AddedNoise& noise = {},
                 const EstimatedSigmas& sigmas = {});

  /// The same with registrations of these.
  std::unique_ptr<VisualOdometry> told(const EstimatedSigmas& sigmas) const;

  const Camera& camera() const override { return source_.camera(); }
  std::size_t size() const override { return source_.size(); }
  const FrameInfo& info(std::size_t i) const override;
  cv::Mat image(std::size_t i) const override { return source_.image(i); }
  std::uint64_t picture_id(std::size_t i) const override { return source_.picture_id(i); }
  bool has_odometry() const override { return true; }
  bool has_ground_truth() const override { return source_.has_ground_truth(); }
  SetUpFiles set_up_files() const override { return source_.set_up_files(); }
  bool is_visual_odometry() const override { return true; }

  /// Frames so far that did not register with the one before.
  std::size_t failures() const { return failures_; }

 private:
  MeasuredFrame measured(std::size_t frame) const;
  /// Of the frame after those in infos_.
  void measure_motion(FrameInfo& frame) const;

  const FrameSource& source_;
  PairRegistrar& registrar_;
  VisualOdometryFallback fallback_;
  AddedNoise noise_;
  EstimatedSigmas sigmas_;
  MotionNoise draws_;
  mutable RandomStream stream_;
  mutable Pose last_motion_;
  mutable std::deque<FrameInfo> infos_;  ///< of a growing vector no reference would hold
  mutable std::size_t failures_ = 0;
};

}  // namespace fathom
