// Loop candidates and their registrations, as the front end hands them on.

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include "front_end/survey_run.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;
using test::Given;
using test::keyframe_every;
using test::step_covariance;
using test::SurveyRun;
using test::truth_of;

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

}  // namespace
}  // namespace fathom
