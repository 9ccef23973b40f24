#include "fathom/measurements/shared_errors.hpp"

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "measurements/shared_log.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::numerical_jacobian;
using test::SharedWalk;
using testing::HasSubstr;

// Of registrations that are told, one below the other: ν, and its covariance own + G Gᵀ.
struct Joint {
  Eigen::MatrixXd G;
  Eigen::MatrixXd own;
  Eigen::VectorXd nu;
};

Joint joint_of(const std::vector<RelativePose>& told, std::size_t keyframes,
               const std::vector<Pose>& poses) {
  const auto rows = static_cast<Eigen::Index>(3 * told.size());
  const auto unknowns = static_cast<Eigen::Index>(3 * keyframes);
  Joint joint{Eigen::MatrixXd::Zero(rows, unknowns), Eigen::MatrixXd::Zero(rows, rows),
              Eigen::VectorXd(rows)};
  for (Eigen::Index i = 0; i < rows; i += 3) {
    const RelativePose& z = told[static_cast<std::size_t>(i / 3)];
    joint.nu.segment<3>(i) = z.motion.vector() - between(poses[z.from], poses[z.to]).vector();
    joint.nu[i + 2] = wrap_angle(joint.nu[i + 2]);
    joint.own.block<3, 3>(i, i) = z.shared->own;
    joint.G.block<3, 3>(i, static_cast<Eigen::Index>(3 * z.from)) = z.shared->from.scaled();
    joint.G.block<3, 3>(i, static_cast<Eigen::Index>(3 * z.to)) = z.shared->to.scaled();
  }
  return joint;
}

// νᵀ C⁻¹ ν with C the whole covariance of the registrations that are told, block by block.
double naive_chi2(const MeasurementLog& log, const std::vector<Pose>& poses) {
  std::vector<RelativePose> told;
  double sum = 0.0;
  for (const RelativePose& z : log.edges()) {
    if (z.shared) {
      told.push_back(z);
    } else {
      sum += chi2(z, poses[z.from], poses[z.to]);
    }
  }
  const Joint joint = joint_of(told, log.size(), poses);
  return sum + joint.nu.dot((joint.own + joint.G * joint.G.transpose()).ldlt().solve(joint.nu));
}

TEST(SharedErrors, ChiSquaredEqualsThatOfTheJointCovariance) {
  for (const int per_keyframe : {1, 5}) {
    const SharedWalk walk(30, per_keyframe, 7);
    ASSERT_TRUE(walk.log.tells_shared_errors());
    for (const std::vector<Pose>& poses : {walk.truth, walk.log.odometry()}) {
      const double expected = naive_chi2(walk.log, poses);
      EXPECT_NEAR(shared_chi2(walk.log, poses), expected, 1e-9 * expected);
      EXPECT_GT(std::abs(chi2(walk.log, poses) - expected), 1e-6 * expected);
    }
  }
}

TEST(SharedErrors, OwnErrorsAreWhatTheJointCovarianceExpects) {
  const SharedWalk walk(30, 5, 8);
  std::vector<RelativePose> told;
  for (const RelativePose& z : walk.log.edges()) {
    if (z.shared) told.push_back(z);
  }
  const auto rows = static_cast<Eigen::Index>(3 * told.size());
  const Joint joint = joint_of(told, walk.log.size(), walk.truth);
  // The conditional mean of ν's own part: own (own + G Gᵀ)⁻¹ ν.
  const Eigen::VectorXd expected =
      joint.own * (joint.own + joint.G * joint.G.transpose()).ldlt().solve(joint.nu);
  const std::vector<Eigen::Vector3d> errors = own_errors(walk.log, walk.truth);
  ASSERT_EQ(3 * errors.size(), static_cast<std::size_t>(rows));
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_LT((errors[i] - expected.segment<3>(static_cast<Eigen::Index>(3 * i))).norm(), 1e-9);
  }
}

TEST(SharedErrors, ChiSquaredIsThatOfTheParts) {
  // Each picture in one registration alone: nothing is shared.
  MeasurementLog log = SharedWalk(3, 1, 1).log;
  ASSERT_TRUE(log.tells_shared_errors());
  const std::vector<Pose> poses = log.odometry();
  EXPECT_NEAR(shared_chi2(log, poses), chi2(log, poses), 1e-9 * chi2(log, poses));
}

TEST(SharedErrors, DrawnAsToldTheyAverageToTheDegreesOfFreedom) {
  double shared = 0.0;
  double degrees = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SharedWalk walk(20, 5, seed);
    shared += shared_chi2(walk.log, walk.truth);
    degrees += 3.0 * static_cast<double>(walk.log.edges().size());
  }
  // Six standard deviations.
  EXPECT_NEAR(shared / degrees, 1.0, 6.0 * std::sqrt(2.0 / degrees));
}

TEST(SharedErrors, ReversedRespondAsTheInverseDoes) {
  RandomStream random(3, "reversed");
  for (const RelativePose& z : SharedWalk(12, 5, 2).log.edges()) {
    if (!z.shared) continue;
    const RelativePose back = z.reversed();
    const Eigen::Matrix3d J =
        numerical_jacobian([](const Pose& motion) { return inverse(motion).vector(); }, z.motion);
    EXPECT_LT((back.shared->from.G - J * z.shared->to.G).norm(), 1e-7);
    EXPECT_LT((back.shared->to.G - J * z.shared->from.G).norm(), 1e-7);
    EXPECT_EQ(back.shared->from.sigma, z.shared->to.sigma);
    EXPECT_TRUE(back.shared->total().isApprox(back.covariance(), 1e-9));
    EXPECT_TRUE(back.reversed().shared->total().isApprox(z.shared->total(), 1e-9));
  }
}

TEST(SharedFile, ReadsBackToTheSameBits) {
  const SharedWalk walk(25, 4, 3);
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "graph.g2o";
  write_graph(file, walk.log);
  const MeasurementLog read = read_g2o(file);
  EXPECT_EQ(text_of(read), text_of(walk.log));
  // Where nothing is told there is no file, and one from before goes.
  MeasurementLog untold;
  untold.add_keyframe(walk.log.arrival(1).step);
  write_graph(file, untold);
  EXPECT_FALSE(std::filesystem::exists(shared_file_of(file)));
  EXPECT_EQ(text_of(untold), to_g2o(untold));
}

// With an edge there is no hole (G2oHole), and a step shares nothing: so of the registration that
// becomes one.
TEST(SharedFile, WhatStandsOfAStepIsLeftAside) {
  const SharedWalk walk(12, 4, 3);
  MeasurementLog log;
  RelativePose hole = walk.log.arrival(1).step;
  hole.is_hole = true;
  log.add_keyframe(hole);
  RelativePose across = RelativePose::from_covariance(0, 1, hole.motion, hole.covariance());
  across.shared = std::make_shared<const SharedErrors>(SharedErrors{{}, {}, across.covariance()});
  log.add_registration(across);
  const SharedText shared{to_shared(log), "graph.shared"};
  const MeasurementLog over_hole = parse_g2o(to_g2o(log), "graph.g2o", {}, &shared);
  EXPECT_EQ(over_hole.hole_count(), 1U);
  EXPECT_TRUE(over_hole.tells_shared_errors());
  MeasurementLog step;
  step.add_keyframe(across);
  const MeasurementLog read = parse_g2o(to_g2o(step), "graph.g2o", {}, &shared);
  EXPECT_EQ(read.registration_count(), 0U);
  EXPECT_EQ(read.arrival(1).step.shared, nullptr);
  EXPECT_FALSE(read.tells_shared_errors());
}

TEST(SharedFile, WithoutItTheGraphIsTheSame) {
  const SharedWalk walk(25, 4, 3);
  const MeasurementLog read = parse_g2o(to_g2o(walk.log), "graph.g2o");
  EXPECT_FALSE(read.tells_shared_errors());
  EXPECT_EQ(to_g2o(read), to_g2o(walk.log));
}

// One registration of keyframes 0 and 2, each part of it 0.01.
const std::string kSharedGraph =
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2 0 2 2 0 0 50 0 0 50 0 50\n";
const std::string kPictures = "PICTURE 0 0.1 0.1 0.1\nPICTURE 2 0 0 0\n";
const std::string kUnit = " 1 0 0 0 1 0 0 0 1";
const std::string kOwn = " 0.01 0 0 0.01 0 0.01";
const std::string kGoodShared = kPictures + "REGISTRATION 0 2 2 0 0" + kUnit + kUnit + kOwn + "\n";

std::string error_of(const std::string& shared) {
  const SharedText beside{shared, "graph.shared"};
  return input_error_of([&] { parse_g2o(kSharedGraph, "graph.g2o", {}, &beside); });
}

TEST(SharedFile, FaultsAreNamedWithFileAndLine) {
  const SharedText good{kGoodShared, "graph.shared"};
  ASSERT_TRUE(parse_g2o(kSharedGraph, "graph.g2o", {}, &good).tells_shared_errors());
  const std::string registration = "REGISTRATION 0 2 2 0 0" + kUnit + kUnit;
  const std::string not_definite = " 0.01 0.02 0 0.01 0 0.01\n";
  const std::vector<std::pair<std::string, std::pair<std::string, std::string>>> faults{
      {"PICTURE 0 0.1 0.1 0.1\n" + registration + kOwn, {":2: ", "a line PICTURE 2"}},
      {kGoodShared + "PICTURE 1 1 1 1\n", {":4: ", "picture 1, but no registration"}},
      {kGoodShared + "PICTURE 2 1 1 1\n", {":4: ", "on line 2 already"}},
      {"PICTURE 0 -1 0 0\n", {":1: ", "expected 0 or more"}},
      {"PICTURE 0 nan 0 0\n", {":1: ", "'nan' is not a finite number"}},
      {"PICTURE" + std::string(2 << 20, ' ') + "0 1 1 1\n", {":1: ", "more than a mebibyte"}},
      {"PICTURE 0 1 1\n", {":1: ", "an id and three standard deviations"}},
      {"PICTURE -1 1 1 1\n", {":1: ", "'-1' is not an id"}},
      {"PRIOR 0 1\n", {":1: ", "expected PICTURE or REGISTRATION"}},
      {kPictures + registration + not_definite, {":3: ", "not positive definite"}},
      {kPictures + registration + " 0.02 0 0 0.02 0 0.02\n", {":3: ", "do not add up"}},
      {kPictures + "REGISTRATION 0 2 2.1 0 0" + kUnit + kUnit + kOwn,
       {":3: ", "no edge 0 2 with this motion in graph.g2o: a file of another log"}},
      {kGoodShared + "REGISTRATION 0 2 2 0 0" + kUnit + kUnit + kOwn, {":4: ", "no edge 0 2"}}};
  for (const auto& [text, expected] : faults) {
    const std::string message = error_of(text);
    EXPECT_THAT(message, testing::StartsWith("graph.shared" + expected.first)) << text;
    EXPECT_THAT(message, HasSubstr(expected.second));
  }
}

}  // namespace
}  // namespace fathom
