#include "fathom/evaluation/spatial_alignment.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/evaluation/spatial_accuracy.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using Trajectory = std::vector<StampedSpatialPose>;

Trajectory drawn(RandomStream& random, std::size_t count) {
  Trajectory trajectory;
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector3d p{random.normal(), 2.0 * random.normal(), random.normal()};
    trajectory.push_back({static_cast<std::int64_t>(k), {p, Eigen::Quaterniond::Identity()}});
  }
  return trajectory;
}

// Least Σ |Rot_z(ψ) p + t − q|² over ψ and t, by search over ψ: for each the best t is the
// difference of the means.
double least_sum(const Trajectory& estimate, const Trajectory& reference) {
  const auto sum_at = [&](double psi) {
    const Eigen::AngleAxisd turn(psi, Eigen::Vector3d::UnitZ());
    std::vector<Eigen::Vector3d> differences;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < estimate.size(); ++k) {
      differences.push_back(reference[k].pose.position_m - turn * estimate[k].pose.position_m);
      mean += differences.back() / static_cast<double>(estimate.size());
    }
    double sum = 0.0;
    for (const Eigen::Vector3d& d : differences) sum += (d - mean).squaredNorm();
    return sum;
  };
  double best = 0.0;
  double width = std::numbers::pi;
  for (int round = 0; round < 60; ++round) {
    for (const double psi : {best - width, best - width / 2, best + width / 2, best + width}) {
      if (sum_at(psi) < sum_at(best)) best = psi;
    }
    if (round > 3) width *= 0.7;
  }
  return sum_at(best);
}

double sum_of_squares(const Trajectory& estimate, const Trajectory& reference,
                      SpatialAlignment alignment) {
  const SpatialAccuracy judged = spatial_accuracy(estimate, reference, {}, alignment);
  double sum = 0.0;
  for (const double d : with_heights(judged.position_errors_m, judged.height_errors_m)) {
    sum += d * d;
  }
  return sum;
}

TEST(SpatialAlignment, YawIsTheLeastSquaresOfFourDegreesOfFreedom) {
  RandomStream random(1, "yaw");
  for (int trial = 0; trial < 20; ++trial) {
    const Trajectory estimate = drawn(random, 8);
    const Trajectory reference = drawn(random, 8);
    const double yaw = sum_of_squares(estimate, reference, SpatialAlignment::yaw);
    EXPECT_NEAR(yaw, least_sum(estimate, reference), 1e-7 * yaw);
    EXPECT_LT(yaw, sum_of_squares(estimate, reference, SpatialAlignment::se2));
  }
}

TEST(SpatialAlignment, YawUndoesAMotionAboutTheVertical) {
  RandomStream random(2, "yaw");
  const Trajectory reference = drawn(random, 12);
  Trajectory estimate = reference;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.5, Eigen::Vector3d::UnitZ()));
  for (auto& [time, pose] : estimate) {
    pose.position_m = turn * pose.position_m + Eigen::Vector3d(30, -20, 10);
    pose.rotation = turn * pose.rotation;
  }
  for (const auto alignment : {SpatialAlignment::yaw, SpatialAlignment::origin}) {
    const SpatialAccuracy judged = spatial_accuracy(estimate, reference, {}, alignment);
    EXPECT_LT(judged.accuracy->ate_rmse_m, 1e-13);
    EXPECT_LT(judged.accuracy->heading_rmse_rad, 1e-13);
    for (const double height_m : judged.height_errors_m) EXPECT_NEAR(height_m, 0.0, 1e-13);
  }
  // A tilt is what it does not undo.
  for (auto& [time, pose] : estimate) {
    pose.position_m = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()) * pose.position_m;
  }
  EXPECT_GT(sum_of_squares(estimate, reference, SpatialAlignment::yaw), 0.05);
}

TEST(SpatialAlignment, OnThePlaneYawIsSe2AndHeightsDiffer) {
  RandomStream random(3, "yaw");
  const Trajectory estimate = drawn(random, 9);
  const Trajectory reference = drawn(random, 9);
  const auto by_yaw = spatial_accuracy(estimate, reference, {}, SpatialAlignment::yaw);
  const auto by_se2 = spatial_accuracy(estimate, reference, {}, SpatialAlignment::se2);
  EXPECT_EQ(by_yaw.position_errors_m, by_se2.position_errors_m);
  EXPECT_EQ(by_yaw.heading_errors_rad, by_se2.heading_errors_rad);
  EXPECT_NE(by_yaw.height_errors_m, by_se2.height_errors_m);
}

TEST(SpatialAlignment, HeightsByName) {
  const std::vector<double> estimate{1, 2, 6};
  const std::vector<double> reference{2, 2, 2};
  EXPECT_EQ(height_shift_m(estimate, reference, SpatialAlignment::none), 0.0);
  EXPECT_EQ(height_shift_m(estimate, reference, SpatialAlignment::se2), 0.0);
  EXPECT_EQ(height_shift_m(estimate, reference, SpatialAlignment::origin), 1.0);
  EXPECT_EQ(height_shift_m(estimate, reference, SpatialAlignment::yaw), -1.0);
  EXPECT_EQ(height_shift_m({}, {}, SpatialAlignment::yaw), 0.0);
  EXPECT_NE(test::input_error_of([&] { height_shift_m(estimate, {}, SpatialAlignment::yaw); }),
            "(nothing thrown)");
}

TEST(SpatialAccuracy, KnowsTwoMountings) {
  RandomStream random(4, "mounting");
  const Trajectory reference = drawn(random, 5);
  Trajectory estimate = reference;
  EXPECT_TRUE(spatial_accuracy(estimate, reference, {}, {}).is_mounted_alike);
  // The axes of a camera that looks forward: x right, y down, z forward.
  for (auto& [time, pose] : estimate) pose.rotation = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  EXPECT_FALSE(spatial_accuracy(estimate, reference, {}, {}).is_mounted_alike);
}

}  // namespace
}  // namespace fathom
