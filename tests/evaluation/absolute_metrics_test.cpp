// Metrics of absolute measurements and holes, by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/example_run.hpp"

namespace fathom {
namespace {

using test::ExampleRun;
using test::values_of;
using ::testing::Contains;
using ::testing::Key;
using ::testing::Not;

// The example with a heading of keyframe 0, a fix and a second heading of keyframe 1.
ExampleRun with_absolute() {
  ExampleRun example;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  example.log = MeasurementLog();
  example.log.add_absolute(AbsolutePose::heading(0, 0.2, 0.1));
  example.log.add_keyframe(RelativePose::from_covariance(0, 1, {1, 0, 0}, one));
  example.log.add_absolute(AbsolutePose::position(1, {1.5, 0}, 0.25 * Eigen::Matrix2d::Identity()));
  example.log.add_absolute(AbsolutePose::heading(1, 0.0, 0.1));
  RelativePose hole = RelativePose::from_covariance(1, 2, {7, 0, 0}, one);
  hole.is_hole = true;
  example.log.add_keyframe(hole);
  example.log.add_registration(RelativePose::from_covariance(0, 2, {2, 0, 0}, one));
  example.run.absolute = {
      {0, LoopFate::used, 3.0}, {1, LoopFate::used, 6.0}, {1, LoopFate::rejected, 50.0}};
  example.run.absolute_weights = {1.0, 0.3, 0.0};
  example.run.absolute_chi2_used = 4.5;
  return example;
}

TEST(AbsoluteMetrics, HandNumbers) {
  const ExampleRun example = with_absolute();
  const auto values = values_of(example.facts());
  EXPECT_EQ(values.at("absolute_measurements"), 3.0);
  EXPECT_EQ(values.at("absolute_used"), 2.0);
  EXPECT_EQ(values.at("absolute_rejected"), 1.0);
  EXPECT_EQ(values.at("absolute_lost"), 0.0);
  EXPECT_EQ(values.at("absolute_kept"), 1.0);
  EXPECT_EQ(values.at("mean_nis_absolute"), 3.0);  // 9 over 1 + 2 degrees
  // 0.2 rad of 0.1, 0.5 m of 0.5: 4 + 1, at the estimate as at the truth; 4 degrees.
  EXPECT_NEAR(values.at("absolute_chi2"), 5.0, 1e-12);
  EXPECT_NEAR(values.at("mean_nis_truth_absolute"), 5.0 / 4.0, 1e-12);
  EXPECT_EQ(values.at("absolute_chi2_used"), 4.5);
  EXPECT_EQ(values.at("holes"), 1.0);
  // A registration, four rows, a hole.
  EXPECT_EQ(values.at("degrees_of_freedom"), 4.0);
  // The loop's error is (0.3, 0, 0.1); the hole costs nothing.
  EXPECT_NEAR(values.at("chi2"), 5.0 + 0.1, 1e-12);
  EXPECT_NEAR(values.at("chi2_per_dof"), 5.1 / 4.0, 1e-12);
}

TEST(AbsoluteMetrics, AreAbsentOfALogWithoutAny) {
  const ExampleRun example;
  const auto values = values_of(example.facts());
  for (const auto& [name, value] : values) {
    EXPECT_EQ(name.find("absolute"), std::string::npos) << name;
  }
  EXPECT_THAT(values, Not(Contains(Key("holes"))));
  EXPECT_THAT(values, Not(Contains(Key("degrees_of_freedom"))));
  const ExampleRun absolute = with_absolute();
  RunFacts facts = absolute.facts();
  facts.run = nullptr;
  EXPECT_THAT(values_of(facts), Not(Contains(Key("absolute_chi2"))));
}

// A start that is not exact adds a term to F and a pose to what is estimated.
TEST(AbsoluteMetrics, AnUncertainStartCostsAsAMeasurement) {
  ExampleRun example;
  StartPose start(Pose{0.3, 0, 0});
  start.covariance = Eigen::Vector3d(0.09, 1, 1).asDiagonal();
  example.log.set_start(start);
  const auto values = values_of(example.facts());
  EXPECT_NEAR(values.at("absolute_chi2"), 1.0, 1e-12);
  EXPECT_EQ(values.at("degrees_of_freedom"), 3.0);
  EXPECT_THAT(values, Not(Contains(Key("absolute_used"))));
  start.is_free = true;
  example.log.set_start(start);
  const auto free = values_of(example.facts());
  EXPECT_EQ(free.at("absolute_chi2"), 0.0);
  // Nothing says where a free one is, so that it takes no degree.
  EXPECT_EQ(free.at("degrees_of_freedom"), 3.0);
  EXPECT_NEAR(free.at("chi2_per_dof"), 0.2 / 3.0, 1e-12);
}

}  // namespace
}  // namespace fathom
