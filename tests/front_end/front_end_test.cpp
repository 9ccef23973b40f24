#include "fathom/front_end/front_end.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/front_end/visual_odometry.hpp"
#include "front_end/survey_run.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;
using test::Given;
using test::input_error_of;
using test::keyframe_every;
using test::step_covariance;
using test::SurveyRun;
using test::truth_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::size_t> frames_of(const std::vector<Keyframe>& keyframes) {
  std::vector<std::size_t> frames;
  for (const Keyframe& keyframe : keyframes) frames.push_back(keyframe.frame);
  return frames;
}

TEST(FrontEnd, TakesAKeyframeEverySoManyFrames) {
  FloorSurvey survey(bend(9));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(3, 0.0));
  EXPECT_THAT(frames_of(run.front_end.keyframes()), ElementsAre(0, 3, 6));
  for (std::size_t k = 0; k < 3; ++k) {
    const Keyframe& keyframe = run.front_end.keyframes()[k];
    EXPECT_EQ(keyframe.index, k);
    EXPECT_EQ(keyframe.time_ns, survey.info(keyframe.frame).time_ns);
    EXPECT_EQ(keyframe.step.has_value(), k > 0);
  }
}

TEST(FrontEnd, OneFrameIsOneKeyframe) {
  FloorSurvey survey(bend(1));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(10));
  EXPECT_THAT(frames_of(run.front_end.keyframes()), ElementsAre(0));
  EXPECT_TRUE(run.registrations.empty());
}

// Composition through homogeneous matrices and numerical derivatives.
UncertainPose naive_composition(const UncertainPose& A, const UncertainPose& B) {
  const auto product = [](const Pose& a, const Pose& b) {
    return test::t2v(test::homogeneous(a) * test::homogeneous(b));
  };
  const Eigen::Matrix3d J_A =
      test::numerical_jacobian([&](const Pose& a) { return product(a, B.mean); }, A.mean);
  const Eigen::Matrix3d J_B =
      test::numerical_jacobian([&](const Pose& b) { return product(A.mean, b); }, B.mean);
  return {Pose::from_vector(product(A.mean, B.mean)),
          J_A * A.covariance * J_A.transpose() + J_B * B.covariance * J_B.transpose()};
}

TEST(FrontEnd, AStepIsTheCompositionOfTheMotionsSince) {
  FloorSurvey survey(bend(9));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(4, 0.0));
  for (std::size_t k = 1; k < 3; ++k) {
    UncertainPose expected;
    for (std::size_t i = 4 * k - 3; i <= 4 * k; ++i) {
      expected = naive_composition(expected, *survey.info(i).motion);
    }
    const RelativePose& step = *run.front_end.keyframes()[k].step;
    EXPECT_EQ(step.from, k - 1);
    EXPECT_EQ(step.to, k);
    EXPECT_LT(test::distance(step.motion, expected.mean), 1e-12);
    EXPECT_LT((step.covariance() - expected.covariance).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(FrontEnd, KnowsWhereEveryFrameIs) {
  FloorSurvey survey(bend(9));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(4, 0.0));
  const auto& places = run.front_end.frames();
  ASSERT_EQ(places.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(places[i].keyframe, i / 4);
    EXPECT_EQ(places[i].time_ns, survey.info(i).time_ns);
    const Pose place = compose(survey.truth(4 * (i / 4)), places[i].motion_since_keyframe);
    EXPECT_LT(test::distance(place, survey.truth(i)), 1e-12) << i;
  }
}

TEST(FrontEnd, KnowsWhereFramesAfterTheLastKeyframeAre) {
  FloorSurvey survey(bend(7));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(4, 0.0));
  const auto& places = run.front_end.frames();
  ASSERT_EQ(places.size(), 7u);
  EXPECT_EQ(places[6].keyframe, 1u);
  EXPECT_LT(
      test::distance(compose(survey.truth(4), places[6].motion_since_keyframe), survey.truth(6)),
      1e-12);
}

TEST(FrontEnd, ABlankPictureDoesNotStopTheRun) {
  FloorSurvey survey(bend(6));
  survey.add_odometry(step_covariance());
  survey.make_blank(3);
  const SurveyRun run(survey, truth_of(survey), keyframe_every(1, 0.5));
  EXPECT_EQ(run.front_end.keyframes().size(), 6u);
  for (const RelativePose& z : run.registrations) {
    EXPECT_NE(z.from, 3u);
    EXPECT_NE(z.to, 3u);
  }
  // 0-1, 0-2, 1-2, 2-4, 4-5 are left of the nine pairs within reach.
  EXPECT_EQ(run.front_end.registrations_tried(), 9u);
  EXPECT_EQ(run.registrations.size(), 5u);
  EXPECT_EQ(run.front_end.keyframes()[3].step->motion, survey.info(3).motion->mean);
}

TEST(FrontEnd, RefusesASourceWithoutOdometry) {
  const FloorSurvey survey(bend(3));
  PairRegistrar registrar(survey, {}, {}, 1);
  EXPECT_THAT(input_error_of([&] { FrontEnd(survey, registrar, {}); }),
              HasSubstr("no dead reckoning; visual odometry can make it"));
}

TEST(FrontEnd, RunsOnVisualOdometry) {
  const FloorSurvey survey(bend(7));
  const FrontEndOptions options = keyframe_every(2, 0.9);
  PairRegistrar registrar(survey, options.features, options.registration, 1);
  const VisualOdometry odometry(survey, registrar, options.visual_odometry);
  FrontEnd front_end(odometry, registrar, options);
  std::vector<Pose> poses{survey.truth(0)};
  std::size_t found = 0;
  while (const auto keyframe = front_end.next_keyframe()) {
    if (keyframe->step) poses.push_back(compose(poses.back(), keyframe->step->motion));
    found += front_end.register_newest(Given(poses)).size();
  }
  ASSERT_EQ(poses.size(), 4u);
  EXPECT_LT(test::distance(poses.back(), survey.truth(6)), 0.02);
  EXPECT_EQ(found, 5u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(survey.times_taken(i), 1) << i;
}

TEST(FrontEnd, NoRegistrationIsBothStepAndLoop) {
  const FloorSurvey survey(bend(4));
  const FrontEndOptions options = keyframe_every(1);
  PairRegistrar registrar(survey, options.features, options.registration, 1);
  const VisualOdometry odometry(survey, registrar, options.visual_odometry);
  const SurveyRun run(odometry, truth_of(survey), options);
  EXPECT_EQ(run.front_end.registrations_tried(), 0u + 0u + 1u + 2u);
  ASSERT_EQ(run.registrations.size(), 3u);
  for (const RelativePose& z : run.registrations) EXPECT_GT(z.to - z.from, 1u);
}

TEST(FrontEnd, APictureThatCannotBeReadIsBadInput) {
  for (const std::size_t frame : {0u, 2u, 4u}) {
    FloorSurvey survey(bend(5));
    survey.add_odometry(step_covariance());
    survey.make_unreadable(frame);
    // From frame 2 on the pictures are read in the background.
    EXPECT_THAT(input_error_of([&] { SurveyRun(survey, truth_of(survey), keyframe_every(2)); }),
                HasSubstr("frame-" + std::to_string(frame) + ": is no picture"));
  }
}

}  // namespace
}  // namespace fathom
