#include "fathom/datasets/noisy_odometry.hpp"

#include <cassert>

namespace fathom {

NoisyOdometry::NoisyOdometry(const FrameSource& source, const AddedNoise& noise) : source_(source) {
  assert(source.has_odometry());
  // Even a draw of zeros would turn -0.0 into 0.0.
  const bool is_noisy = !noise.covariance.isZero(0.0);
  const MotionNoise draws(noise.covariance);
  RandomStream stream(noise.seed, "added_noise", noise.trial);
  infos_.reserve(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    infos_.push_back(source.info(i));
    if (!is_noisy || i == 0) continue;
    UncertainPose& motion = *infos_.back().motion;
    motion.mean = draws.disturb(motion.mean, stream);
    motion.covariance += noise.covariance;
  }
}

}  // namespace fathom
