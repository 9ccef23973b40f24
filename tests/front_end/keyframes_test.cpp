#include "fathom/front_end/keyframes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "front_end/survey_run.hpp"

namespace fathom {
namespace {

using test::FloorSurvey;
using ::testing::ElementsAre;

// Sees 1.406 m ahead and 1.875 m abeam from 1.5 m up.
CameraModel level_camera() {
  CameraModel model = test::small_camera();
  model.mount_x_m = 0.0;
  model.mount_yaw_rad = 0.0;
  return model;
}

std::vector<std::size_t> frames(const FrameSource& survey, const KeyframeOptions& options) {
  KeyframeSchedule schedule(survey, options);
  std::vector<std::size_t> found;
  while (const auto frame = schedule.frame(found.size())) found.push_back(*frame);
  return found;
}

KeyframeOptions overlap(double share) {
  KeyframeOptions options;
  options.kept_overlap = share;
  return options;
}

FloorSurvey ahead(const std::vector<double>& metres) {
  std::vector<Pose> poses;
  for (const double x : metres) poses.push_back({x, 0, 0});
  FloorSurvey survey(poses, level_camera());
  survey.add_odometry(test::step_covariance());
  return survey;
}

TEST(KeyframeSchedule, TakesTheLastFrameThatSharesEnough) {
  const FloorSurvey survey = ahead({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
  // 0.2 m ahead leave 0.858, 0.3 m 0.787.
  EXPECT_THAT(frames(survey, overlap(0.8)), ElementsAre(0, 2, 4, 6));
  EXPECT_THAT(frames(survey, overlap(0.7)), ElementsAre(0, 4));
  EXPECT_THAT(frames(survey, overlap(0.3)), ElementsAre(0));
}

TEST(KeyframeSchedule, WhereNoFrameSharesEnoughTheNextIsTaken) {
  EXPECT_THAT(frames(ahead({0, 1, 2, 2.05, 2.1, 5, 9}), overlap(0.8)),
              ElementsAre(0, 1, 2, 4, 5, 6));
}

// From 50 m up frame 1 would see all later ones. Of 1.406 m, 0.75 m ahead leave 0.47 and 1 m 0.29.
TEST(KeyframeSchedule, NoSingleAltitudeEndsIt) {
  const std::vector<double> metres{0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0};
  EXPECT_THAT(frames(ahead(metres), overlap(0.8)), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  FloorSurvey survey = ahead(metres);
  survey.set_altitude(1, 50.0);
  EXPECT_THAT(frames(survey, overlap(0.8)), ElementsAre(0, 1, 4, 5, 6, 7));
  survey.set_altitude(4, 50.0);
  EXPECT_THAT(frames(survey, overlap(0.8)), ElementsAre(0, 1, 4, 7));
}

TEST(KeyframeSchedule, OfAVehicleThatWaitsThereIsOne) {
  EXPECT_THAT(frames(ahead({0, 0, 0, 0, 0.01, 0}), overlap(0.9)), ElementsAre(0));
}

// A turn in place moves the footprint, too: by a quarter 1.406 of 1.875 m are left.
TEST(KeyframeSchedule, TurnsCount) {
  FloorSurvey survey({{0, 0, 0}, {0, 0, 0.05}, {0, 0, 0.8}, {0, 0, 1.5708}}, level_camera());
  survey.add_odometry(test::step_covariance());
  EXPECT_THAT(frames(survey, overlap(0.9)), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(frames(survey, overlap(0.7)), ElementsAre(0));
}

TEST(KeyframeSchedule, ByNumberNothingElseCounts) {
  KeyframeOptions options;
  options.separation_frames = 3;
  EXPECT_THAT(frames(ahead({0, 0, 0, 0, 9, 9, 9, 9}), options), ElementsAre(0, 3, 6));
  EXPECT_THAT(options.ignored_keys(), ElementsAre("min_overlap"));
}

TEST(KeyframeSchedule, OfNoFramesThereAreNone) {
  EXPECT_TRUE(frames(FloorSurvey({}, level_camera()), overlap(0.9)).empty());
}

TEST(FrontEnd, TakesItsKeyframesByOverlap) {
  const FloorSurvey survey = ahead({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7});
  FrontEndOptions options = test::keyframe_every(1, 0.0);
  options.keyframes = overlap(0.8);
  const test::SurveyRun run(survey, test::truth_of(survey), options);
  ASSERT_EQ(run.front_end.keyframes().size(), 4u);
  EXPECT_NEAR(run.front_end.keyframes()[3].step->motion.x, 0.2, 1e-12);
  EXPECT_EQ(run.front_end.frames().size(), survey.size());
  EXPECT_EQ(run.front_end.frames().back().keyframe, 3u);
  const FrontEndInMetres metres = run.front_end.in_metres();
  EXPECT_NEAR(metres.step_m.median, 0.2, 1e-12);
  EXPECT_EQ(metres.separation_frames.most, 2.0);
  EXPECT_NEAR(metres.max_error_m.median, 7.5 * 1.5 / 160.0, 1e-12);
}

}  // namespace
}  // namespace fathom
