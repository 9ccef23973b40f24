#include "fathom/front_end/visual_odometry.hpp"

#include "fathom/front_end/pair_seed.hpp"
#include "fathom/vision/registration.hpp"

namespace fathom {

VisualOdometry::VisualOdometry(const FrameSource& source, FeatureStore& features,
                               const FrontEndOptions& options, std::uint64_t seed,
                               const AddedNoise& noise)
    : source_(source),
      features_(features),
      options_(options),
      seed_(seed),
      noise_(noise),
      draws_(noise.covariance),
      stream_(noise.seed, "visual_odometry", noise.trial) {}

const FrameInfo& VisualOdometry::info(std::size_t i) const {
  while (infos_.size() <= i) {
    FrameInfo info = source_.info(infos_.size());
    info.motion.reset();
    if (!infos_.empty()) info.motion = next_motion();
    infos_.push_back(std::move(info));
  }
  return infos_[i];
}

UncertainPose VisualOdometry::next_motion() const {
  const std::size_t to = infos_.size();
  const std::size_t from = to - 1;
  features_.announce(to + 1);
  const auto features_from = features_.of(from);
  const auto features_to = features_.of(to);
  const Registration registration = register_pair(
      *features_from, *features_to, options_.registration, pair_seed(seed_, from, to));
  UncertainPose motion{last_motion_, Eigen::Matrix3d::Zero()};
  if (registration.found) {
    motion = {registration.motion, registration.covariance};
    last_motion_ = registration.motion;
  } else {
    ++failures_;
    const double sigma_m = options_.visual_odometry.sigma_m;
    const double sigma_rad = options_.visual_odometry.sigma_rad;
    motion.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  }
  const Eigen::Vector3d noisy = motion.mean.vector() + draws_.draw(stream_);
  return {{noisy.x(), noisy.y(), wrap_angle(noisy.z())}, motion.covariance + noise_.covariance};
}

}  // namespace fathom
