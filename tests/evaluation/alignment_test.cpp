#include "fathom/evaluation/alignment.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"
#include "support/numbers.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::distance;
using test::homogeneous;
using test::input_error_of;
using test::kNaN;
using test::kPi;
using test::random_pose;
using test::t2v;

std::vector<Pose> random_poses(std::size_t count, std::uint64_t seed, double extent_m = 10.0) {
  RandomStream random(seed, "poses");
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) poses.push_back(random_pose(random, extent_m));
  return poses;
}

std::vector<Pose> moved(const std::vector<Pose>& poses, const Pose& motion) {
  std::vector<Pose> result;
  for (const Pose& pose : poses) {
    result.push_back(Pose::from_vector(t2v(homogeneous(motion) * homogeneous(pose))));
  }
  return result;
}

double squared_distance(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += std::pow(a[k].x - b[k].x, 2) + std::pow(a[k].y - b[k].y, 2);
  }
  return sum;
}

TEST(Alignment, NoneKeepsEveryBit) {
  const std::vector<Pose> estimate = random_poses(20, 1);
  const Aligned aligned = align(estimate, random_poses(20, 2), Alignment::none);
  EXPECT_EQ(aligned.poses, estimate);
  EXPECT_EQ(aligned.motion_reference_estimate, Pose{});
}

TEST(Alignment, OriginPutsFirstPoseOnFirstPoseAndKeepsTheShape) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const std::vector<Pose> estimate = random_poses(5, 2 * seed);
    const std::vector<Pose> reference = random_poses(5, 2 * seed + 1);
    const Aligned aligned = align(estimate, reference, Alignment::origin);
    const Eigen::Matrix3d T = homogeneous(reference[0]) * homogeneous(estimate[0]).inverse();
    EXPECT_LT(distance(aligned.motion_reference_estimate, Pose::from_vector(t2v(T))), 1e-12);
    for (std::size_t k = 0; k < estimate.size(); ++k) {
      const Pose expected = Pose::from_vector(t2v(T * homogeneous(estimate[k])));
      EXPECT_LT(distance(aligned.poses[k], expected), 1e-12);
    }
  }
}

TEST(Alignment, Se2FindsAKnownMotion) {
  for (const Pose& motion :
       {Pose{}, Pose{1, -2, 0.3}, Pose{-100, 7, kPi}, Pose{3, 4, -3.1415}, Pose{0, 0, 1e-9}}) {
    const std::vector<Pose> estimate = random_poses(30, 5);
    const Aligned aligned = align(estimate, moved(estimate, motion), Alignment::se2);
    EXPECT_LT(distance(aligned.motion_reference_estimate, motion), 1e-12);
  }
}

TEST(Alignment, Se2IsTheLeastOfABruteForceSearch) {
  const std::vector<Pose> estimate = random_poses(12, 7);
  const std::vector<Pose> reference = random_poses(12, 8);  // unrelated: a large residual
  const Aligned aligned = align(estimate, reference, Alignment::se2);
  const double least = squared_distance(aligned.poses, reference);
  for (int step = 0; step < 720; ++step) {
    // The best shift of a rotation puts mean on mean.
    std::vector<Pose> turned = moved(estimate, {0, 0, step * kPi / 360});
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    for (std::size_t k = 0; k < turned.size(); ++k) {
      shift += (reference[k].position() - turned[k].position()) / 12.0;
    }
    EXPECT_GE(squared_distance(moved(turned, {shift.x(), shift.y(), 0}), reference), least - 1e-9);
  }
  for (const Pose& nudge : {Pose{1e-3, 0, 0}, Pose{-1e-3, 0, 0}, Pose{0, 1e-3, 0},
                            Pose{0, -1e-3, 0}, Pose{0, 0, 1e-3}, Pose{0, 0, -1e-3}}) {
    EXPECT_GT(squared_distance(moved(aligned.poses, nudge), reference), least);
  }
}

TEST(Alignment, Se2NeverReflectsAndNeverScales) {
  const std::vector<Pose> estimate{{0, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  const std::vector<Pose> mirrored{{0, 0, 0}, {2, 0, 0}, {0, -1, 0}};
  const std::vector<Pose> doubled{{0, 0, 0}, {4, 0, 0}, {0, 2, 0}};
  for (const auto& reference : {mirrored, doubled}) {
    const std::vector<Pose> poses = align(estimate, reference, Alignment::se2).poses;
    const Eigen::Vector2d a = poses[1].position() - poses[0].position();
    const Eigen::Vector2d b = poses[2].position() - poses[0].position();
    EXPECT_NEAR(a.x() * b.y() - a.y() * b.x(), 2.0, 1e-12);  // signed area kept
    EXPECT_NEAR(a.norm(), 2.0, 1e-12);
  }
}

TEST(Alignment, Se2OfPosesOnALine) {
  const std::vector<Pose> estimate{{0, 0, 0}, {1, 0, 0}, {5, 0, 0}};
  const Pose motion{3, 1, 2.5};
  const Aligned aligned = align(estimate, moved(estimate, motion), Alignment::se2);
  EXPECT_LT(distance(aligned.motion_reference_estimate, motion), 1e-12);
}

TEST(Alignment, Se2TakesHeadingsWherePositionsLeaveTheRotationOpen) {
  const std::vector<Pose> one{{1, 2, 0.5}};
  EXPECT_LT(distance(align(one, std::vector<Pose>{{-4, 1, -3.0}}, Alignment::se2).poses[0],
                     {-4, 1, -3.0}),
            1e-12);
  // All at one place, whose coordinates do not survive the mean: no spread but rounding.
  const std::vector<Pose> still(7, Pose{4e6 + 0.1, 0.3, 0.2});
  const Aligned aligned = align(still, std::vector<Pose>(7, Pose{1, 1, 0.9}), Alignment::se2);
  EXPECT_NEAR(aligned.motion_reference_estimate.theta, 0.7, 1e-9);
  // A square and its mirror picture: every rotation fits equally badly.
  const std::vector<Pose> square{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  const std::vector<Pose> mirror{{1, 0, 2}, {0, -1, 2}, {-1, 0, 2}, {0, 1, 2}};
  EXPECT_NEAR(align(square, mirror, Alignment::se2).motion_reference_estimate.theta, 2.0, 1e-12);
}

TEST(Alignment, Se2FarFromTheOrigin) {
  const std::vector<Pose> estimate = random_poses(40, 9, 5.0);
  const Pose motion{4.5e6, -3.2e5, 1.1};  // map coordinates
  const Aligned aligned = align(estimate, moved(estimate, motion), Alignment::se2);
  EXPECT_LT(distance(aligned.motion_reference_estimate, motion), 1e-8);
}

TEST(Alignment, NaNIsKept) {
  std::vector<Pose> estimate = random_poses(5, 1);
  const std::vector<Pose> reference = random_poses(5, 2);
  estimate[3].x = kNaN;
  EXPECT_TRUE(std::isnan(align(estimate, reference, Alignment::none).poses[3].x));
  const Aligned by_origin = align(estimate, reference, Alignment::origin);
  EXPECT_TRUE(std::isnan(by_origin.poses[3].x));
  EXPECT_TRUE(is_finite(by_origin.poses[2]));
  for (const Pose& pose : align(estimate, reference, Alignment::se2).poses) {
    EXPECT_FALSE(is_finite(pose));
  }
  estimate[0].theta = kNaN;
  EXPECT_FALSE(is_finite(align(estimate, reference, Alignment::origin).motion_reference_estimate));
}

TEST(Alignment, EmptyAndUnequal) {
  const std::vector<Pose> none;
  const std::vector<Pose> two(2);
  for (const auto& entry : alignment_names()) {
    const std::string& name = entry.first;
    const Alignment alignment = entry.second;
    EXPECT_EQ(align(none, none, alignment).motion_reference_estimate, Pose{}) << name;
    EXPECT_THAT(input_error_of([&] { align(none, two, alignment); }),
                testing::HasSubstr("0 poses and the reference 2"));
    EXPECT_EQ(name_of(alignment), name);
  }
}

}  // namespace
}  // namespace fathom
