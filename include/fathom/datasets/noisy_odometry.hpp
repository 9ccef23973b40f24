#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/motion_noise.hpp"

namespace fathom {

/// A survey with noise added to its recorded dead reckoning: to each frame's motion a draw is
/// added, in the order of the frames, from the stream "added_noise"; to its covariance that of the
/// noise. Without noise the motions are the recorded ones, bit for bit.
class NoisyOdometry : public FrameSource {
 public:
  /// The source must have odometry (asserted), and outlive this.
  NoisyOdometry(const FrameSource& source, const AddedNoise& noise);

  const Camera& camera() const override { return source_.camera(); }
  std::size_t size() const override { return infos_.size(); }
  const FrameInfo& info(std::size_t i) const override { return infos_[i]; }
  cv::Mat image(std::size_t i) const override { return source_.image(i); }
  std::uint64_t picture_id(std::size_t i) const override { return source_.picture_id(i); }
  bool has_odometry() const override { return true; }
  bool has_ground_truth() const override { return source_.has_ground_truth(); }
  SetUpFiles set_up_files() const override { return source_.set_up_files(); }
  bool is_visual_odometry() const override { return source_.is_visual_odometry(); }

 private:
  const FrameSource& source_;
  std::vector<FrameInfo> infos_;
};

}  // namespace fathom
