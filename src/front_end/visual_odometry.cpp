#include "fathom/front_end/visual_odometry.hpp"

namespace fathom {

VisualOdometry::VisualOdometry(const FrameSource& source, PairRegistrar& registrar,
                               const VisualOdometryFallback& fallback, const AddedNoise& noise)
    : source_(source),
      registrar_(registrar),
      fallback_(fallback),
      noise_(noise),
      draws_(noise.covariance),
      stream_(noise.seed, "visual_odometry", noise.trial) {}

const FrameInfo& VisualOdometry::info(std::size_t i) const {
  while (infos_.size() <= i) {
    FrameInfo info = source_.info(infos_.size());
    info.motion.reset();
    info.is_hole = false;
    if (!infos_.empty()) info.motion = next_motion();
    infos_.push_back(std::move(info));
  }
  return infos_[i];
}

MeasuredFrame VisualOdometry::measured(std::size_t frame) const {
  return MeasuredFrame::of(source_, frame);
}

UncertainPose VisualOdometry::next_motion() const {
  const std::size_t to = infos_.size();
  for (std::size_t ahead = to + 1; ahead <= to + PairRegistrar::look_ahead(); ++ahead) {
    if (ahead < source_.size()) registrar_.announce(measured(ahead - 1), measured(ahead));
  }
  const PairRegistration registration = registrar_.of(measured(to - 1), measured(to));
  UncertainPose motion{last_motion_, Eigen::Matrix3d::Zero()};
  if (registration.found) {
    motion = {registration.motion, registration.covariance};
    last_motion_ = registration.motion;
  } else {
    ++failures_;
    const double sigma_m =
        fallback_.sigma_m.value_or(fallback_.sigma_altitudes * measured(to).altitude_m);
    const double sigma_rad = fallback_.sigma_rad;
    motion.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  }
  return {draws_.disturb(motion.mean, stream_), motion.covariance + noise_.covariance};
}

}  // namespace fathom
