#include "fathom/measurements/measurement_log.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/planar.hpp"

namespace fathom {
namespace {

using test::homogeneous;
using test::t2v;

RelativePose random_measurement(std::size_t from, std::size_t to, RandomStream& random) {
  return RelativePose::from_covariance(from, to, test::random_pose(random),
                                       test::random_covariance(random, 0.01));
}

MeasurementLog example() {
  RandomStream random(1, "log");
  MeasurementLog log(Pose{5, -1, 0.7});
  log.add_keyframe(random_measurement(0, 1, random));
  log.add_keyframe(random_measurement(2, 1, random));  // a step written backwards
  log.add_registration(random_measurement(0, 2, random));
  log.add_registration(random_measurement(2, 0, random));
  log.add_keyframe(random_measurement(2, 3, random));
  log.add_registration(random_measurement(1, 3, random));
  return log;
}

TEST(MeasurementLog, StartsWithTheOriginAlone) {
  const MeasurementLog log(Pose{1, 2, 3});
  EXPECT_EQ(log.size(), 1U);
  EXPECT_EQ(log.registration_count(), 0U);
  EXPECT_TRUE(log.edges().empty());
  EXPECT_EQ(log.odometry(), (std::vector<Pose>{{1, 2, 3}}));
  EXPECT_EQ(chi2(log, log.odometry()), 0.0);
}

TEST(MeasurementLog, KeepsTheOrderOfArrival) {
  const MeasurementLog log = example();
  EXPECT_EQ(log.size(), 4U);
  EXPECT_EQ(log.registration_count(), 3U);
  std::vector<std::pair<std::size_t, std::size_t>> order;
  for (const RelativePose& edge : log.edges()) order.emplace_back(edge.from, edge.to);
  EXPECT_EQ(order, (std::vector<std::pair<std::size_t, std::size_t>>{
                       {0, 1}, {2, 1}, {0, 2}, {2, 0}, {2, 3}, {1, 3}}));
  EXPECT_EQ(log.arrival(2).registrations.size(), 2U);
}

TEST(MeasurementLog, OdometryEqualsHomogeneousMatrices) {
  const MeasurementLog log = example();
  Eigen::Matrix3d T = homogeneous(log.origin());
  const std::vector<Pose> odometry = log.odometry();
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose& step = log.arrival(k).step;
    const Eigen::Matrix3d Z = homogeneous(step.motion);
    T = T * (step.from < step.to ? Z : Eigen::Matrix3d(Z.inverse()));
    EXPECT_LT(test::distance(odometry[k], Pose::from_vector(t2v(T))), 1e-12);
  }
}

TEST(MeasurementLog, CostIsTheSumOverTheEdgesAsWritten) {
  const MeasurementLog log = example();
  RandomStream random(2, "trajectory");
  std::vector<Pose> trajectory;
  for (std::size_t k = 0; k < log.size(); ++k) trajectory.push_back(test::random_pose(random));
  double expected = 0.0;
  for (const RelativePose& z : log.edges()) {
    const Eigen::Vector3d e =
        t2v(homogeneous(z.motion).inverse() * homogeneous(trajectory[z.from]).inverse() *
            homogeneous(trajectory[z.to]));
    expected += e.transpose() * z.information * e;
  }
  EXPECT_NEAR(chi2(log, trajectory), expected, 1e-9 * expected);
}

}  // namespace
}  // namespace fathom
