#include "fathom/measurements/measured_parts.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fathom {
namespace {

Eigen::Matrix2d fix_covariance() {
  Eigen::Matrix2d C;
  C << 4.0, 1.5, 1.5, 1.0;
  return C;
}

TEST(MeasuredParts, OfAHeadingAlone) {
  const MeasuredParts parts = parts_of(AbsolutePose::heading(3, -3.1, 0.02));
  EXPECT_FALSE(parts.position);
  EXPECT_TRUE(parts.position_covariance.isZero(0.0));
  EXPECT_NEAR(*parts.heading_rad, -3.1, 1e-12);
  EXPECT_NEAR(parts.heading_sigma_rad, 0.02, 1e-12);
}

TEST(MeasuredParts, OfAPositionAlone) {
  const MeasuredParts parts = parts_of(AbsolutePose::position(3, {7.0, -2.0}, fix_covariance()));
  EXPECT_EQ(*parts.position, Eigen::Vector2d(7.0, -2.0));
  EXPECT_TRUE(parts.position_covariance.isApprox(fix_covariance(), 1e-12));
  EXPECT_FALSE(parts.heading_rad);
}

// Given and shown in world axes, whatever the heading of the measurement's own.
TEST(MeasuredParts, OfAWholePose) {
  Eigen::Matrix3d C;
  C << 4.0, 1.5, 0.1, 1.5, 1.0, -0.05, 0.1, -0.05, 0.04;
  const MeasuredParts parts = parts_of(AbsolutePose::from_covariance(3, {7.0, -2.0, 2.1}, C));
  EXPECT_EQ(*parts.position, Eigen::Vector2d(7.0, -2.0));
  EXPECT_TRUE(parts.position_covariance.isApprox(fix_covariance(), 1e-9));
  EXPECT_NEAR(*parts.heading_rad, 2.1, 1e-12);
  EXPECT_NEAR(parts.heading_sigma_rad, 0.2, 1e-9);
}

// Of rank 2: it informs on the heading, but does not measure it.
TEST(MeasuredParts, OfAFixOfAPointBesideTheKeyframe) {
  const AbsolutePose z =
      fix_of_point(3, {7.0, -2.0}, fix_covariance(), UncertainPose{{2, 0, 0.4}}, {0.5, 1.0}, 1.2);
  ASSERT_GT(z.information(2, 2), 0.0);
  const MeasuredParts parts = parts_of(z);
  EXPECT_EQ(*parts.position, z.pose.position());
  EXPECT_TRUE(parts.position_covariance.isApprox(fix_covariance(), 1e-9));
  EXPECT_FALSE(parts.heading_rad);
}

TEST(MeasuredParts, ALineOfPositionIsNoPosition) {
  AbsolutePose z{3, {7.0, -2.0, 0.5}};
  z.information << 1.0, 2.0, 0.0, 2.0, 4.0, 0.0, 0.0, 0.0, 0.0;
  EXPECT_FALSE(parts_of(z).position);
  EXPECT_FALSE(parts_of(z).heading_rad);
  z.information(2, 2) = 25.0;
  EXPECT_FALSE(parts_of(z).position);
  EXPECT_NEAR(*parts_of(z).heading_rad, 0.5, 1e-12);
}

// Moved with the pose that it measures it says the same of it.
TEST(MeasuredParts, AMovedMeasurementCostsTheSame) {
  const Pose motion{-30.0, 12.0, 2.5};
  const Pose X{6.0, -3.0, 0.9};
  for (const AbsolutePose& z :
       {AbsolutePose::heading(3, 1.1, 0.02), AbsolutePose::position(3, {7, -2}, fix_covariance()),
        fix_of_point(3, {7, -2}, fix_covariance(), UncertainPose{{2, 0, 0.4}}, {0.5, 1.0}, 1.2)}) {
    const AbsolutePose other = moved(z, motion);
    EXPECT_EQ(other.keyframe, 3U);
    EXPECT_NEAR(chi2(other, compose(motion, X)), chi2(z, X), 1e-9 * chi2(z, X));
  }
  const MeasuredParts fix =
      parts_of(moved(AbsolutePose::position(3, {7, -2}, fix_covariance()), motion));
  EXPECT_TRUE(fix.position->isApprox(transform(motion, {7, -2}), 1e-12));
  const Eigen::Matrix2d R = rotation(motion.theta);
  EXPECT_TRUE(fix.position_covariance.isApprox(R * fix_covariance() * R.transpose(), 1e-12));
  const MeasuredParts heading = parts_of(moved(AbsolutePose::heading(3, 1.1, 0.02), motion));
  EXPECT_NEAR(*heading.heading_rad, 1.1 + 2.5 - 2.0 * M_PI, 1e-12);
}

}  // namespace
}  // namespace fathom
