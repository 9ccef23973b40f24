#include "motion_chain.hpp"

namespace fathom {

void MotionChain::append(const FrameInfo& next) {
  Eigen::Matrix3d J_chain;
  Eigen::Matrix3d J_next;
  compose(motion_.mean, next.motion->mean, &J_chain, &J_next);
  motion_ = compose(motion_, *next.motion);
  if (!next.motion_errors) {
    by_newest_.setZero();
    return;
  }
  // The chain moves by J_chain by_newest n and J_next G n of one n: their variances are counted
  // above, what they have in common is not.
  const Eigen::Matrix3d common =
      J_chain * by_newest_ * (J_next * next.motion_errors->from.scaled()).transpose();
  motion_.covariance += common + common.transpose();
  by_newest_ = J_next * next.motion_errors->to.scaled();
}

}  // namespace fathom
