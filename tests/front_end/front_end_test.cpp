#include "fathom/front_end/front_end.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include "fathom/front_end/visual_odometry.hpp"
#include "front_end/floor_survey.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;
using test::input_error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Eigen::Matrix3d step_covariance() {
  Eigen::Matrix3d C;
  C << 4e-4, 1e-4, -5e-5,  //
      1e-4, 2e-4, 3e-5,    //
      -5e-5, 3e-5, 1e-4;
  return C;
}

FrontEndOptions keyframe_every(int frames, double max_distance_m = 100.0) {
  FrontEndOptions options;
  options.separation_frames = frames;
  options.candidates.max_distance_m = max_distance_m;
  return options;
}

/// A trajectory that somebody else estimated.
class Given : public TrajectoryView {
 public:
  explicit Given(std::vector<Pose> poses) : poses_(std::move(poses)) {}
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

 private:
  std::vector<Pose> poses_;
};

Given truth_of(const FloorSurvey& survey) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < survey.size(); ++i) poses.push_back(survey.truth(i));
  return Given(poses);
}

/// The front end over a survey, with every registration that it finds.
struct SurveyRun {
  SurveyRun(const FrameSource& survey, const TrajectoryView& view, const FrontEndOptions& options,
            std::uint64_t seed = 1)
      : registrar(survey, options.features, options.registration, seed),
        front_end(survey, registrar, options) {
    while (const auto keyframe = front_end.next_keyframe()) {
      for (RelativePose& z : front_end.register_newest(view)) registrations.push_back(z);
    }
  }

  PairRegistrar registrar;
  FrontEnd front_end;
  std::vector<RelativePose> registrations;
};

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

TEST(FrontEnd, CandidatesAreTheKeyframesNearTheNewestAsEstimated) {
  FloorSurvey survey(bend(5));
  survey.add_odometry(step_covariance());
  // The view is believed, not the truth: keyframe 4 is 5 m from the origin in it.
  const Given view({{0, 0, 0}, {3, 4, 1}, {-1, 0, 0}, {3, 4.5, 0}, {3, 4, -2}});
  const auto tried = [&](double max_distance_m) {
    PairRegistrar registrar(survey, {}, {}, 1);
    FrontEnd front_end(survey, registrar, keyframe_every(1, max_distance_m));
    while (front_end.keyframes().size() < 5) front_end.next_keyframe();
    front_end.register_newest(view);
    return front_end.registrations_tried();
  };
  EXPECT_EQ(tried(0.0), 1u);  // at the same place: the bound is included
  EXPECT_EQ(tried(0.499), 1u);
  EXPECT_EQ(tried(0.5), 2u);
  EXPECT_EQ(tried(4.999), 2u);
  EXPECT_EQ(tried(5.0), 3u);
  EXPECT_EQ(tried(100.0), 4u);
}

/// Dead reckoning that knows its uncertainty.
class Reckoned : public TrajectoryView {
 public:
  explicit Reckoned(const FrameSource& survey) {
    for (std::size_t i = 1; i < survey.size(); ++i) motions_.push_back(*survey.info(i).motion);
  }

  void advance() { ++size_; }
  std::size_t size() const override { return size_; }
  Pose pose(std::size_t k) const override { return compose_chain({motions_.data(), k}).mean; }
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override {
    std::vector<UncertainPose> motions;
    for (std::size_t k = 0; k + 1 < size_; ++k) {
      motions.push_back(compose_chain({motions_.data() + k, size_ - 1 - k}));
    }
    return motions;
  }

 private:
  std::vector<UncertainPose> motions_;
  std::size_t size_ = 0;
};

// Out and back: the last picture is the first one's place again. Dead reckoning is 1.3 m off by
// then, four times its sigma of 0.36 m, but within three of the 0.5 m where candidates are looked
// for.
TEST(FrontEnd, ByMahalanobisADriftedEstimateStillFindsItsLoop) {
  std::vector<Pose> truth;
  for (int i = 0; i < 7; ++i) truth.push_back({-1.2 + 0.4 * i, 0.0, 0.0});
  for (int i = 6; i >= 0; --i) truth.push_back({-1.2 + 0.4 * i, 0.1, 0.0});
  FloorSurvey survey(truth);
  survey.add_odometry(Eigen::Vector3d(0.01, 0.01, 1e-8).asDiagonal(), {0.1, 0.0, 0.0});
  const auto loops_of_the_last = [&](CandidateMethod method) {
    FrontEndOptions options = keyframe_every(1, 0.5);
    options.candidates.method = method;
    PairRegistrar registrar(survey, {}, {}, 1);
    FrontEnd front_end(survey, registrar, options);
    Reckoned reckoned(survey);
    std::vector<RelativePose> found;
    while (front_end.next_keyframe()) {
      reckoned.advance();
      found = front_end.register_newest(reckoned);
    }
    return found;
  };
  for (const RelativePose& z : loops_of_the_last(CandidateMethod::distance)) EXPECT_GT(z.from, 1u);
  const auto found = loops_of_the_last(CandidateMethod::mahalanobis);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front().from, 0u);
  EXPECT_LT(test::distance(found.front().motion, between(truth.front(), truth.back())), 0.008);
}

TEST(FrontEnd, RegistersNoMoreThanTheBudgetAndCountsTheRest) {
  FloorSurvey survey(bend(6));
  survey.add_odometry(step_covariance());
  const SurveyRun all(survey, truth_of(survey), keyframe_every(1, 0.7));
  EXPECT_EQ(all.front_end.registrations_left_out(), 0u);
  FrontEndOptions options = keyframe_every(1, 0.7);
  options.candidates.max_per_keyframe = 2;
  const SurveyRun two(survey, truth_of(survey), options);
  EXPECT_EQ(two.front_end.registrations_tried(), 1u + 2u + 2u + 2u + 2u);
  EXPECT_EQ(two.front_end.registrations_left_out(), 3u);
  // On a path that goes on ahead the last two overlap most.
  std::vector<RelativePose> expected = all.registrations;
  std::erase_if(expected, [](const RelativePose& z) { return z.to - z.from > 2; });
  ASSERT_EQ(two.registrations.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(two.registrations[i].from, expected[i].from);
    EXPECT_EQ(two.registrations[i].motion, expected[i].motion);
  }
}

TEST(FrontEnd, RegistrationsAreTheTrueMotions) {
  FloorSurvey survey(bend(6));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(1, 0.7));
  EXPECT_EQ(run.front_end.registrations_tried(), 3u + 3u + 3u + 2u + 1u);
  ASSERT_EQ(run.registrations.size(), run.front_end.registrations_tried());
  EXPECT_EQ(run.front_end.registrations_found(), run.registrations.size());
  for (const RelativePose& z : run.registrations) {
    EXPECT_LT(z.from, z.to);
    const Pose truth = between(survey.truth(z.from), survey.truth(z.to));
    EXPECT_LT(test::distance(z.motion, truth), 0.008) << z.from << " -> " << z.to;
    EXPECT_TRUE(is_positive_definite(z.information));
    EXPECT_GE(z.inliers.value_or(0), RansacOptions{}.min_inliers);
  }
}

TEST(FrontEnd, KeyframesWithoutOverlapAreNotFound) {
  // Out and back: the first and the last look at the same place, the second elsewhere.
  FloorSurvey survey({{-1.2, 0, 0}, {1.2, 0.3, 0}, {-1.15, 0.1, 0.2}});
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(1));
  EXPECT_EQ(run.front_end.registrations_tried(), 3u);
  ASSERT_EQ(run.registrations.size(), 1u);
  EXPECT_EQ(run.registrations[0].from, 0u);
  EXPECT_EQ(run.registrations[0].to, 2u);
}

TEST(FrontEnd, GivesRegistrationsByRisingKeyframe) {
  FloorSurvey survey(bend(5));
  survey.add_odometry(step_covariance());
  const SurveyRun run(survey, truth_of(survey), keyframe_every(1));
  EXPECT_TRUE(std::is_sorted(run.registrations.begin(), run.registrations.end(),
                             [](const RelativePose& a, const RelativePose& b) {
                               return std::pair(a.to, a.from) < std::pair(b.to, b.from);
                             }));
}

void expect_same(const std::vector<RelativePose>& a, const std::vector<RelativePose>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].from, b[i].from);
    EXPECT_EQ(a[i].to, b[i].to);
    EXPECT_EQ(a[i].motion, b[i].motion);
    EXPECT_EQ(a[i].information, b[i].information);
    EXPECT_EQ(a[i].inliers, b[i].inliers);
  }
}

TEST(FrontEnd, TheNumberOfThreadsDoesNotMatter) {
  FloorSurvey survey(bend(5));
  survey.add_odometry(step_covariance());
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const SurveyRun one(survey, truth_of(survey), keyframe_every(1));
  cv::setNumThreads(2);
  const SurveyRun two(survey, truth_of(survey), keyframe_every(1));
  cv::setNumThreads(before);
  ASSERT_FALSE(one.registrations.empty());
  expect_same(one.registrations, two.registrations);
}

TEST(FrontEnd, ARegistrationDoesNotDependOnWhichOthersAreTried) {
  FloorSurvey survey(bend(5));
  survey.add_odometry(step_covariance());
  const SurveyRun few(survey, truth_of(survey), keyframe_every(1, 0.3));
  SurveyRun many(survey, truth_of(survey), keyframe_every(1));
  ASSERT_EQ(few.registrations.size(), 4u);
  std::erase_if(many.registrations, [](const RelativePose& z) { return z.to - z.from > 1; });
  expect_same(few.registrations, many.registrations);
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
