// Sensors that run at other rates than the camera.

#include <cmath>
#include <string>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::FolderFixture;

TEST(ImageFolderRates, AltitudeIsInterpolatedInTime) {
  FolderFixture fixture;
  fixture.files["altimeter0/data.csv"] = "-400,1\n600,2\n1600,4\n2600,3\n";
  const ImageFolder folder(fixture.write());
  EXPECT_NEAR(folder.info(0).altitude_m, 1.4, 1e-15);
  EXPECT_NEAR(folder.info(1).altitude_m, 2.8, 1e-15);
  EXPECT_NEAR(folder.info(2).altitude_m, 3.6, 1e-15);
}

// Steps of half the interval: the motions and covariances of two compose to a frame's.
TEST(ImageFolderRates, FasterOdometryIsComposed) {
  FolderFixture fixture;
  fixture.files["odometry0/data.csv"] =
      "0,5,5,1,0,0,0\n500,5.5,5.1,1.2,0.01,0.02,0.001,0.002,0.0001,-0.0001\n"
      "1000,5.9,5.6,1.1,0.03,0.01,0.002,-0.001,0.0002,0.0003\n"
      "1500,6,6,1,0.01,0.01,0.001\n2000,6,6.5,0.9,0.01,0.01,0.001\n";
  const ImageFolder folder(fixture.write());
  const Eigen::Matrix3d A = test::homogeneous({5, 5, 1});
  const Eigen::Matrix3d B = test::homogeneous({5.5, 5.1, 1.2});
  const Eigen::Matrix3d C = test::homogeneous({5.9, 5.6, 1.1});
  const Pose first = Pose::from_vector(test::t2v(A.inverse() * B));
  const Pose second = Pose::from_vector(test::t2v(B.inverse() * C));
  EXPECT_LT((folder.info(1).motion->mean.vector() - test::t2v(A.inverse() * C)).norm(), 1e-14);
  const auto compose_naively = [](const Pose& a, const Pose& b) {
    return test::t2v(test::homogeneous(a) * test::homogeneous(b));
  };
  const Eigen::Matrix3d J1 =
      test::numerical_jacobian([&](const Pose& p) { return compose_naively(p, second); }, first);
  const Eigen::Matrix3d J2 =
      test::numerical_jacobian([&](const Pose& p) { return compose_naively(first, p); }, second);
  Eigen::Matrix3d C1;
  C1 << 0.01, 0.002, 0.0001, 0.002, 0.02, -0.0001, 0.0001, -0.0001, 0.001;
  Eigen::Matrix3d C2;
  C2 << 0.03, -0.001, 0.0002, -0.001, 0.01, 0.0003, 0.0002, 0.0003, 0.002;
  const Eigen::Matrix3d expected = J1 * C1 * J1.transpose() + J2 * C2 * J2.transpose();
  EXPECT_LT((folder.info(1).motion->covariance - expected).norm(), 1e-9);
}

// On a straight run without turning, the interpolated motion and covariance are proportional to
// time, and the parts add up to the whole.
TEST(ImageFolderRates, OdometryBetweenPicturesIsShared) {
  FolderFixture fixture;
  fixture.files["odometry0/data.csv"] = "-500,0,0,0,0,0,0\n2500,6,3,0,0.3,0.6,0.03\n";
  const ImageFolder folder(fixture.write());
  for (std::size_t i = 1; i < 3; ++i) {
    const UncertainPose& motion = *folder.info(i).motion;
    EXPECT_NEAR(motion.mean.x, 2.0, 1e-14);
    EXPECT_NEAR(motion.mean.y, 1.0, 1e-14);
    EXPECT_NEAR(motion.covariance(0, 0), 0.1, 1e-14);
    EXPECT_NEAR(motion.covariance(1, 1), 0.2, 1e-14);
    EXPECT_NEAR(motion.covariance(2, 2), 0.01, 1e-14);
  }
}

// A quarter turn on the spot, cut in half: the second part's covariance is in axes turned by 45°.
TEST(ImageFolderRates, CutCovarianceIsInThePartsOwnFrame) {
  FolderFixture fixture;
  fixture.files["odometry0/data.csv"] =
      "0,0,0,0,0,0,0\n2000,0,0,1.5707963267948966,0.04,0.01,0.002\n";
  const ImageFolder folder(fixture.write());
  Eigen::Matrix3d first;
  first << 0.02, 0, 0, 0, 0.005, 0, 0, 0, 0.001;
  Eigen::Matrix3d second;
  second << 0.0125, -0.0075, 0, -0.0075, 0.0125, 0, 0, 0, 0.001;
  EXPECT_LT((folder.info(1).motion->covariance - first).norm(), 1e-15);
  EXPECT_LT((folder.info(2).motion->covariance - second).norm(), 1e-15);
}

// Pictures at rows' times and between: motions chain to the odometry's own, whatever the cuts.
TEST(ImageFolderRates, CutMotionsChainToTheOdometrysOwn) {
  FolderFixture fixture;
  fixture.files["cam0/data.csv"] = "0,a.png\n700,b.png\n2000,c.png\n";
  fixture.files["odometry0/data.csv"] =
      "0,1,2,0.3,0,0,0\n900,2,2.5,1.1,0.01,0.01,0.001\n1100,2,3,1.9,0.01,0.01,0.001\n"
      "2000,1,4,-3,0.01,0.01,0.001\n";
  const ImageFolder folder(fixture.write());
  const Eigen::Matrix3d chained = test::homogeneous(folder.info(1).motion->mean) *
                                  test::homogeneous(folder.info(2).motion->mean);
  const Eigen::Matrix3d whole =
      test::homogeneous({1, 2, 0.3}).inverse() * test::homogeneous({1, 4, -3});
  EXPECT_LT((chained - whole).norm(), 1e-12);
  EXPECT_TRUE(is_positive_definite(folder.info(1).motion->covariance));
}

TEST(ImageFolderRates, GroundTruthIsInterpolatedAcrossPi) {
  FolderFixture fixture;
  const auto quaternion = [](double yaw) {
    return std::to_string(std::cos(yaw / 2)) + ",0,0," + std::to_string(std::sin(yaw / 2));
  };
  fixture.files["state_groundtruth_estimate0/data.csv"] = "-1000,0,0,0," + quaternion(3.0) +
                                                          "\n1000,0,0,0," + quaternion(-3.0) +
                                                          "\n3000,8,0,0," + quaternion(-3.0) + "\n";
  const ImageFolder folder(fixture.write());
  EXPECT_TRUE(folder.has_ground_truth());
  EXPECT_NEAR(std::abs(folder.info(0).ground_truth->theta), 3.14159265, 1e-5);
  EXPECT_NEAR(folder.info(2).ground_truth->x, 4.0, 1e-5);
}

}  // namespace
}  // namespace fathom
