#include "fathom/evaluation/accuracy.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/data.hpp"
#include "support/input_error.hpp"
#include "support/numbers.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::homogeneous;
using test::input_error_of;
using test::kPi;
using test::t2v;
using testing::HasSubstr;

const double kBad[] = {std::numeric_limits<double>::quiet_NaN(),
                       std::numeric_limits<double>::infinity()};

TEST(Accuracy, HandNumbers) {
  const std::vector<Pose> reference{{0, 0, 0}, {1, 0, 0}, {2, 0, 3.1}, {3, 0, 0}};
  const std::vector<Pose> estimate{{0, 0, 0}, {4, 4, 0.5}, {2, 0, -3.1}, {3, -2, 0}};
  const auto result = accuracy(estimate, reference, Alignment::none);
  ASSERT_TRUE(result);
  EXPECT_DOUBLE_EQ(result->mean_position_error_m, (0 + 5 + 0 + 2) / 4.0);
  EXPECT_DOUBLE_EQ(result->ate_rmse_m, std::sqrt((25 + 4) / 4.0));
  EXPECT_DOUBLE_EQ(result->max_position_error_m, 5);
  EXPECT_DOUBLE_EQ(result->final_position_error_m, 2);
  const double across = 2 * kPi - 6.2;  // the short way from 3.1 to −3.1
  EXPECT_NEAR(result->heading_rmse_rad, std::sqrt((0.25 + across * across) / 4), 1e-15);
  EXPECT_EQ(result->alignment, Alignment::none);
  EXPECT_EQ(result->motion_reference_estimate, Pose{});
}

TEST(Accuracy, OfOnePoseThereIsNoneUnlessItIsComparedAsItIs) {
  const std::vector<Pose> reference{{1, 2, 0.5}};
  const std::vector<Pose> estimate{{4, 6, 0.25}};
  EXPECT_FALSE(accuracy(estimate, reference, Alignment::origin));
  EXPECT_FALSE(accuracy(estimate, reference, Alignment::se2));
  EXPECT_EQ(accuracy(estimate, reference, Alignment::none)->mean_position_error_m, 5.0);
}

TEST(Accuracy, SeesOnlyTheShapeOnceAligned) {
  RandomStream random(3, "accuracy");
  std::vector<Pose> reference;
  std::vector<Pose> estimate;
  const Pose world{5, -3, 2.5};
  for (int k = 0; k < 30; ++k) {
    reference.push_back(test::random_pose(random));
    estimate.push_back(Pose::from_vector(t2v(homogeneous(world) * homogeneous(reference.back()))));
  }
  EXPECT_GT(accuracy(estimate, reference, Alignment::none)->mean_position_error_m, 1.0);
  for (const Alignment alignment : {Alignment::origin, Alignment::se2}) {
    const auto result = accuracy(estimate, reference, alignment);
    EXPECT_LT(result->max_position_error_m, 1e-12);
    EXPECT_LT(result->heading_rmse_rad, 1e-12);
    EXPECT_NEAR(result->motion_reference_estimate.theta, -2.5, 1e-12);
  }
}

TEST(Accuracy, Se2NeverExceedsTheOtherAlignmentsRmse) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "rmse");
    std::vector<Pose> reference;
    std::vector<Pose> estimate;
    for (int k = 0; k < 10; ++k) {
      reference.push_back(test::random_pose(random));
      estimate.push_back(test::random_pose(random));
    }
    const double least = accuracy(estimate, reference, Alignment::se2)->ate_rmse_m;
    EXPECT_LE(least, accuracy(estimate, reference, Alignment::none)->ate_rmse_m);
    EXPECT_LE(least, accuracy(estimate, reference, Alignment::origin)->ate_rmse_m);
  }
}

TEST(Accuracy, OneBadKeyframeIsNeverLeftOut) {
  const std::vector<Pose> good{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const double bad : kBad) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (const auto member : {&Pose::x, &Pose::y, &Pose::theta}) {
        std::vector<Pose> poses = good;
        poses[k].*member = bad;
        for (const auto& [name, alignment] : alignment_names()) {
          EXPECT_FALSE(accuracy(poses, good, alignment)) << name;
          EXPECT_FALSE(accuracy(good, poses, alignment)) << name;
        }
        EXPECT_FALSE(relative_error(poses, good, 1));
        EXPECT_FALSE(relative_error_over(good, poses, 1.0));
        EXPECT_FALSE(relative_error_over(poses, good, 1.0));
      }
    }
  }
}

TEST(Accuracy, ErrorsTooLargeForADoubleAreNoResult) {
  const std::vector<Pose> reference{{0, 0, 0}, {1, 0, 0}};
  const std::vector<Pose> estimate{{0, 0, 0}, {1e200, 0, 0}};
  EXPECT_FALSE(accuracy(estimate, reference, Alignment::origin));
  EXPECT_FALSE(relative_error(estimate, reference, 1));
}

TEST(Accuracy, RefusesWhatCannotBeCompared) {
  const std::vector<Pose> none;
  const std::vector<Pose> two(2);
  const std::vector<Pose> three(3);
  const auto accuracy_of = [](const auto& a, const auto& b) {
    return input_error_of([&] { accuracy(a, b, Alignment::origin); });
  };
  EXPECT_THAT(accuracy_of(none, none), HasSubstr("no pose"));
  EXPECT_THAT(accuracy_of(two, three), HasSubstr("2 poses and the reference 3"));
  EXPECT_THAT(input_error_of([&] { position_errors_m(two, three); }), HasSubstr("equally many"));
  EXPECT_THAT(input_error_of([&] { heading_errors_rad(two, three); }), HasSubstr("equally many"));
  EXPECT_THAT(input_error_of([&] { relative_error(two, three, 1); }), HasSubstr("equally many"));
  EXPECT_THAT(input_error_of([&] { relative_error(two, two, 0); }), HasSubstr("at least 1"));
  for (const double distance_m : {0.0, -1.0, kBad[0]}) {
    EXPECT_THAT(input_error_of([&] { relative_error_over(two, two, distance_m); }),
                HasSubstr("above 0 m"));
  }
}

// The reference goes 1 m a step; the estimate goes 1.1 m and turns by 0.01 rad too much.
struct Drift {
  std::vector<Pose> reference{Pose{}};
  std::vector<Pose> estimate{Pose{2, 1, -2}};

  Drift() {
    for (int k = 0; k < 10; ++k) {
      reference.push_back(compose(reference.back(), {1, 0, 0.2}));
      estimate.push_back(compose(estimate.back(), {1.1, 0, 0.21}));
    }
  }
};

TEST(RelativeError, OfAConstantDrift) {
  const Drift drift;
  const auto result = relative_error(drift.estimate, drift.reference, 1);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->pairs, 10U);
  EXPECT_NEAR(result->translation_mean_m, 0.1, 1e-14);
  EXPECT_NEAR(result->translation_rmse_m, 0.1, 1e-14);
  EXPECT_NEAR(result->rotation_mean_rad, 0.01, 1e-14);
  EXPECT_NEAR(relative_error(drift.estimate, drift.reference, 4)->rotation_rmse_rad, 0.04, 1e-14);
  EXPECT_EQ(relative_error(drift.estimate, drift.reference, 10)->pairs, 1U);
  EXPECT_FALSE(relative_error(drift.estimate, drift.reference, 11));
}

TEST(RelativeError, EqualsHomogeneousMatrices) {
  RandomStream random(9, "rpe");
  std::vector<Pose> estimate;
  std::vector<Pose> reference;
  for (int k = 0; k < 12; ++k) {
    estimate.push_back(test::random_pose(random));
    reference.push_back(test::random_pose(random));
  }
  double sum_m = 0.0;
  double squares_rad = 0.0;
  for (std::size_t k = 0; k + 3 < 12; ++k) {
    const Eigen::Matrix3d R = homogeneous(reference[k]).inverse() * homogeneous(reference[k + 3]);
    const Eigen::Matrix3d E = homogeneous(estimate[k]).inverse() * homogeneous(estimate[k + 3]);
    const Eigen::Vector3d e = t2v(R.inverse() * E);
    sum_m += e.head<2>().norm();
    squares_rad += e.z() * e.z();
  }
  const auto result = relative_error(estimate, reference, 3);
  EXPECT_NEAR(result->translation_mean_m, sum_m / 9, 1e-12);
  EXPECT_NEAR(result->rotation_rmse_rad, std::sqrt(squares_rad / 9), 1e-12);
}

TEST(RelativeError, OverDistances) {
  // Steps of 1, 1, 0, 3, 1 m: from each keyframe the first at 2 m or more.
  const std::vector<Pose> reference{{0, 0, 0}, {1, 0, 0}, {2, 0, 0},
                                    {2, 0, 0}, {5, 0, 0}, {6, 0, 0}};
  std::vector<Pose> estimate = reference;
  estimate[4].y = 0.5;
  // Pairs (0,2) (1,4) (2,4) (3,4); from 4 on only 1 m is left.
  const auto result = relative_error_over(estimate, reference, 2.0);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->pairs, 4U);
  EXPECT_NEAR(result->translation_mean_m, 3 * 0.5 / 4, 1e-15);
  EXPECT_NEAR(result->translation_rmse_m, std::sqrt(3 * 0.25 / 4), 1e-15);
  EXPECT_EQ(relative_error_over(estimate, reference, 6.0)->pairs, 1U);
  EXPECT_FALSE(relative_error_over(estimate, reference, 6.01));
  EXPECT_FALSE(relative_error_over(std::vector<Pose>(5), std::vector<Pose>(5), 1.0));
}

// Columns `columns` of an ASL data.csv as poses; where there are four, the last two are qw and qz.
std::vector<Pose> read_poses(const std::filesystem::path& path, const std::vector<int>& columns) {
  std::ifstream file(path);
  std::vector<Pose> poses;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<double> v;
    std::stringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    const auto at = [&](int i) {
      return v[static_cast<std::size_t>(columns[static_cast<std::size_t>(i)])];
    };
    poses.push_back({at(0), at(1), columns.size() == 3 ? at(2) : 2 * std::atan2(at(3), at(2))});
  }
  return poses;
}

// What the data's own README says of its dead reckoning: 2.57 m.
TEST(Accuracy, DeadReckoningOfRealPictures) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  const auto odometry = read_poses(test::data_path("copr/mav0/odometry0/data.csv"), {1, 2, 3});
  const auto truth =
      read_poses(test::data_path("copr/mav0/state_groundtruth_estimate0/data.csv"), {1, 2, 4, 7});
  ASSERT_EQ(odometry.size(), 38U);
  const auto result = accuracy(odometry, truth, Alignment::origin);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->mean_position_error_m, 2.5690572354022088, 1e-9);
}

}  // namespace
}  // namespace fathom
