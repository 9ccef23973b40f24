#include "fathom/datasets/frame_source.hpp"

namespace fathom {

RecordedOdometry FrameSource::recorded_odometry() const {
  RecordedOdometry odometry;
  if (!has_odometry()) return odometry;
  Pose pose;
  double heading_rad = 0.0;
  for (std::size_t i = 0; i < size(); ++i) {
    const FrameInfo& frame = info(i);
    if (i > 0) {
      pose = compose(pose, frame.motion->mean);
      heading_rad += frame.motion->mean.theta;
    }
    odometry.rows.push_back({frame.time_ns, pose.x, pose.y, heading_rad, frame.is_hole});
  }
  return odometry;
}

}  // namespace fathom
