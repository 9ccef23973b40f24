#include "fathom/harness/frame_remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Pictures every metre from 2 m up, which see 1.92 m ahead; keyframes are those of these numbers.
Recording ahead(std::size_t frames, const std::vector<std::size_t>& keyframes) {
  Recording recording;
  recording.camera = Camera();
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    const auto step_m = static_cast<double>(keyframes[k] - keyframes[k - 1]);
    recording.log.add_keyframe(RelativePose::from_covariance(k - 1, k, {step_m, 0, 0},
                                                             1e-4 * Eigen::Matrix3d::Identity()));
  }
  recording.keyframe_stances.assign(keyframes.size(), 2.0);
  recording.frame_stances.assign(frames, 2.0);
  std::size_t k = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    if (k + 1 < keyframes.size() && i == keyframes[k + 1]) ++k;
    const auto since_m = static_cast<double>(i - keyframes[k]);
    recording.frames.push_back({500'000'000 * static_cast<std::int64_t>(i), k, {since_m, 0, 0}});
  }
  return recording;
}

TEST(FrameRemarks, FramesThatShareFloorWithAKeyframeHaveNone) {
  EXPECT_FALSE(frame_remark(ahead(8, {0, 3, 6})));
  EXPECT_FALSE(frame_remark(ahead(3, {0, 1, 2})));
  EXPECT_FALSE(frame_remark(Recording()));
}

TEST(FrameRemarks, BehindTheLastKeyframeAndBetweenTwo) {
  EXPECT_THAT(frame_remark(ahead(10, {0, 3})).value(),
              AllOf(HasSubstr("5 of 10 frames share no floor"),
                    HasSubstr("the first is frame 5, t = 2.5"), HasSubstr("front_end.keyframes")));
  EXPECT_THAT(frame_remark(ahead(7, {0, 6})).value(), HasSubstr("3 of 7 frames"));
}

TEST(FrameRemarks, KeyframesWithoutGroundTruth) {
  Recording recording = ahead(10, {0, 3, 6});
  for (const std::size_t frame : {0U, 3U, 6U}) {
    recording.keyframe_times_ns.push_back(recording.frames[frame].time_ns);
  }
  EXPECT_FALSE(truth_remark(recording));
  recording.frame_ground_truth = {{0, {}}, {500'000'000, {}}, {3'000'000'000, {}}};
  EXPECT_THAT(truth_remark(recording).value(),
              AllOf(HasSubstr("missing at 1 of 3 keyframes (the first at t = 1.5"),
                    HasSubstr("no error is computed")));
  recording.ground_truth = std::vector<Pose>(3);
  EXPECT_FALSE(truth_remark(recording));
}

// From 50 m up keyframe 1 would see all of them.
TEST(FrameRemarks, ALargeAltitudeDoesNotReachFurther) {
  Recording recording = ahead(10, {0, 3});
  recording.keyframe_stances[1] = 50.0;
  EXPECT_THAT(frame_remark(recording).value(), HasSubstr("5 of 10 frames"));
}

}  // namespace
}  // namespace fathom
