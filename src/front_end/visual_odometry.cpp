#include "fathom/front_end/visual_odometry.hpp"

namespace fathom {

VisualOdometry::VisualOdometry(const FrameSource& source, PairRegistrar& registrar,
                               const VisualOdometryFallback& fallback, const AddedNoise& noise,
                               const EstimatedSigmas& sigmas)
    : source_(source),
      registrar_(registrar),
      fallback_(fallback),
      noise_(noise),
      sigmas_(sigmas),
      draws_(noise.covariance),
      stream_(noise.seed, "visual_odometry", noise.trial) {}

std::unique_ptr<VisualOdometry> VisualOdometry::told(const EstimatedSigmas& sigmas) const {
  return std::make_unique<VisualOdometry>(source_, registrar_, fallback_, noise_, sigmas);
}

const FrameInfo& VisualOdometry::info(std::size_t i) const {
  while (infos_.size() <= i) {
    FrameInfo info = source_.info(infos_.size());
    info.motion.reset();
    info.motion_errors.reset();
    info.is_hole = false;
    if (!infos_.empty()) measure_motion(info);
    infos_.push_back(std::move(info));
  }
  return infos_[i];
}

MeasuredFrame VisualOdometry::measured(std::size_t frame) const {
  return MeasuredFrame::of(source_, frame);
}

void VisualOdometry::measure_motion(FrameInfo& frame) const {
  const std::size_t to = infos_.size();
  for (std::size_t ahead = to + 1; ahead <= to + PairRegistrar::look_ahead(); ++ahead) {
    if (ahead < source_.size()) registrar_.announce(measured(ahead - 1), measured(ahead));
  }
  const MeasuredFrame from = measured(to - 1);
  const PairRegistration registration =
      sigmas_.told(registrar_.of(from, measured(to)), from, measured(to));
  UncertainPose motion{last_motion_, Eigen::Matrix3d::Zero()};
  if (registration.found) {
    motion = {registration.motion, registration.covariance};
    last_motion_ = registration.motion;
    if (registration.shared.is_shared()) {
      frame.motion_errors = std::make_shared<const SharedErrors>(registration.shared);
    }
  } else {
    ++failures_;
    const double sigma_m =
        fallback_.sigma_m.value_or(fallback_.sigma_altitudes * measured(to).altitude_m);
    const double sigma_rad = fallback_.sigma_rad;
    motion.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  }
  frame.motion = {draws_.disturb(motion.mean, stream_), motion.covariance + noise_.covariance};
}

}  // namespace fathom
