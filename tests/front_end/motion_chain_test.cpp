#include "src/front_end/motion_chain.hpp"

#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

Eigen::Matrix3d random_matrix(RandomStream& random, double size) {
  Eigen::Matrix3d M;
  for (int i = 0; i < 9; ++i) M(i) = size * random.normal();
  return M;
}

// A motion that is a registration; its covariance has more, as of added noise.
FrameInfo registered(RandomStream& random) {
  SharedErrors errors;
  errors.from = {random_matrix(random, 1.0), {0.03, 0.01, 0.02}};
  errors.to = {random_matrix(random, 1.0), {0.02, 0.01, 0.02}};
  errors.own = 1e-4 * Eigen::Matrix3d::Identity();
  FrameInfo frame;
  const double x = random.uniform(-1.0, 1.0);
  frame.motion = UncertainPose{{x, 0.3, random.uniform(-3.0, 3.0)},
                               errors.total() + 2e-4 * Eigen::Matrix3d::Identity()};
  frame.motion_errors = std::make_shared<const SharedErrors>(errors);
  return frame;
}

Pose end_of(const std::vector<Pose>& motions) {
  Pose pose;
  for (const Pose& motion : motions) pose = compose(pose, motion);
  return pose;
}

// ∂end/∂motion i by central differences.
Eigen::Matrix3d derivative_by(std::vector<Pose> motions, std::size_t i) {
  constexpr double kStep = 1e-6;
  const Pose at = motions[i];
  Eigen::Matrix3d J;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    motions[i] = Pose::from_vector(at.vector() + step);
    const Pose up = end_of(motions);
    motions[i] = Pose::from_vector(at.vector() - step);
    const Pose down = end_of(motions);
    J.col(axis) << up.x - down.x, up.y - down.y, wrap_angle(up.theta - down.theta);
  }
  return J / (2.0 * kStep);
}

// The joint covariance of all motions, through the derivatives of the end by them.
Eigen::Matrix3d dense_covariance(const std::vector<FrameInfo>& frames) {
  const auto size = 3 * static_cast<Eigen::Index>(frames.size());
  Eigen::MatrixXd joint = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd H(3, size);
  std::vector<Pose> motions;
  for (const FrameInfo& frame : frames) motions.push_back(frame.motion->mean);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    H.middleCols<3>(row) = derivative_by(motions, i);
    joint.block<3, 3>(row, row) = frames[i].motion->covariance;
    if (i == 0 || !frames[i].motion_errors || !frames[i - 1].motion_errors) continue;
    const PictureErrors& before = frames[i - 1].motion_errors->to;
    const PictureErrors& after = frames[i].motion_errors->from;
    joint.block<3, 3>(row - 3, row) = before.scaled() * after.scaled().transpose();
    joint.block<3, 3>(row, row - 3) = joint.block<3, 3>(row - 3, row).transpose();
  }
  return H * joint * H.transpose();
}

TEST(MotionChain, EqualsTheJointCovarianceOfMotionsThatSharePictures) {
  RandomStream random(31);
  std::vector<FrameInfo> frames;
  MotionChain chain;
  for (int i = 0; i < 8; ++i) {
    frames.push_back(registered(random));
    // Pictures that did not register: the motion after shares nothing with the one before.
    if (i == 4) frames.back().motion_errors = nullptr;
    chain.append(frames.back());
    const Eigen::Matrix3d expected = dense_covariance(frames);
    EXPECT_LT((chain.motion().covariance - expected).norm(), 1e-7 * expected.norm()) << i;
  }
  EXPECT_TRUE(is_positive_definite(chain.motion().covariance));
}

TEST(MotionChain, OfMotionsThatShareNothingIsTheirComposition) {
  RandomStream random(32);
  MotionChain chain;
  UncertainPose expected;
  for (int i = 0; i < 5; ++i) {
    FrameInfo frame = registered(random);
    frame.motion_errors = nullptr;
    chain.append(frame);
    expected = compose(expected, *frame.motion);
    EXPECT_EQ(chain.motion().mean, expected.mean);
    EXPECT_EQ(chain.motion().covariance, expected.covariance);
  }
}

// What is wrong with a picture between two moves the first motion and the second against it.
TEST(MotionChain, AnErrorThatCancelsLeavesNothing) {
  FrameInfo there, back;
  SharedErrors errors;
  errors.to = {Eigen::Matrix3d::Identity(), {0.1, 0.2, 0.0}};
  there.motion = UncertainPose{{1.0, 0.0, 0.0}, errors.total()};
  there.motion_errors = std::make_shared<const SharedErrors>(errors);
  std::swap(errors.from, errors.to);
  errors.from.G *= -1.0;
  back.motion = UncertainPose{{1.0, 0.0, 0.0}, errors.total()};
  back.motion_errors = std::make_shared<const SharedErrors>(errors);
  MotionChain chain;
  chain.append(there);
  EXPECT_GT(chain.motion().covariance.norm(), 0.03);
  chain.append(back);
  EXPECT_LT(chain.motion().covariance.norm(), 1e-17);
}

}  // namespace
}  // namespace fathom
