#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/front_end/registration_cache.hpp"

namespace fathom {

/// A survey whose pictures take long to make, with each of them made once and kept in a cache
/// beyond the life of a process: the same frames, the same pictures bit for bit.
class RenderedPictures : public FrameSource {
 public:
  /// Both must outlive this.
  RenderedPictures(const FrameSource& source, PictureCache& cache)
      : source_(source), cache_(cache) {}

  const Camera& camera() const override { return source_.camera(); }
  std::size_t size() const override { return source_.size(); }
  const FrameInfo& info(std::size_t i) const override { return source_.info(i); }
  cv::Mat image(std::size_t i) const override;
  std::uint64_t picture_id(std::size_t i) const override { return source_.picture_id(i); }
  cv::Mat given_mask() const override { return source_.given_mask(); }
  std::string picture_name(std::size_t i) const override { return source_.picture_name(i); }
  bool has_odometry() const override { return source_.has_odometry(); }
  bool has_ground_truth() const override { return source_.has_ground_truth(); }
  RecordedOdometry recorded_odometry() const override { return source_.recorded_odometry(); }
  SetUpFiles set_up_files() const override { return source_.set_up_files(); }
  bool is_visual_odometry() const override { return source_.is_visual_odometry(); }

 private:
  const FrameSource& source_;
  PictureCache& cache_;
};

}  // namespace fathom
