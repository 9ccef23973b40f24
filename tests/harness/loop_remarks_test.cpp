#include "fathom/harness/loop_remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Sees 2.56 m abeam and 1.92 m ahead.
constexpr double kAltitudeM = 2.0;

/// A survey at these true poses: exact steps, and registrations of what the test says.
Recording survey(const std::vector<Pose>& poses) {
  Recording recording;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    recording.log.add_keyframe(RelativePose::from_covariance(
        k - 1, k, between(poses[k - 1], poses[k]), 1e-4 * Eigen::Matrix3d::Identity()));
  }
  recording.camera = Camera();
  recording.keyframe_stances.assign(poses.size(), kAltitudeM);
  recording.in_metres.emplace();
  recording.in_metres->reach_m = {2.3, 2.3, 2.3};
  return recording;
}

/// The same with a registration of each keyframe with the one before.
Recording chained(const std::vector<Pose>& poses) {
  Recording recording = survey(poses);
  MeasurementLog log;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const RelativePose& step = recording.log.arrival(k).step;
    log.add_keyframe(step);
    log.add_registration(RelativePose::from_covariance(k - 1, k, step.motion, step.covariance()));
    ++recording.registrations_tried;
  }
  recording.log = log;
  return recording;
}

std::vector<Pose> ahead(std::size_t count, double step_m) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) poses.push_back({step_m * static_cast<double>(k), 0, 0});
  return poses;
}

std::vector<std::string> remarks_on(const Recording& recording) {
  return loop_remarks(recording, {}, recording.log.odometry());
}

TEST(LoopRemarks, WithoutCandidatesNameTheReachAndTheNearestPass) {
  EXPECT_THAT(remarks_on(survey(ahead(20, 3.0))),
              ElementsAre(AllOf(HasSubstr("no loop candidates among 20 keyframes"),
                                HasSubstr("2.3 m"), HasSubstr("never returns"))));
  std::vector<Pose> out_and_back = ahead(10, 3.0);
  for (int k = 9; k >= 0; --k) out_and_back.push_back({3.0 * k, 7.0, M_PI});
  EXPECT_THAT(remarks_on(survey(out_and_back)),
              ElementsAre(AllOf(HasSubstr("nearest pass"), HasSubstr("is 7 m away"),
                                HasSubstr("max_distance_m"))));
}

TEST(LoopRemarks, WithoutARegistrationNameTheBestRefused) {
  Recording recording = survey(ahead(5, 0.5));
  recording.registrations_tried = 10;
  recording.most_refused_inliers = 9;
  EXPECT_THAT(remarks_on(recording),
              ElementsAre(AllOf(HasSubstr("0 of 10 candidate pairs"), HasSubstr("9 matches agree"),
                                HasSubstr("at least 12"))));
}

TEST(LoopRemarks, WhatIsRightHasNone) {
  EXPECT_THAT(remarks_on(chained(ahead(12, 1.0))), IsEmpty());
}

// 0.4 m apart each keyframe shares 30 % or more with the next three: 1.2 of 1.92 m.
TEST(LoopRemarks, FewerRegistrationsThanTheOverlapPromisesAreCounted) {
  Recording recording = chained(ahead(12, 0.4));
  EXPECT_THAT(remarks_on(recording), IsEmpty());  // all that were tried
  recording.registrations_tried = 40;
  EXPECT_THAT(remarks_on(recording),
              ElementsAre(AllOf(HasSubstr("11 registrations"), HasSubstr("30 pairs"))));
}

}  // namespace
}  // namespace fathom
