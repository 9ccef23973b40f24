// Keys that a choice made in another key has a use for, or would ignore.

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"

namespace fathom {
namespace {

using test::configured;
using test::in_force;
using test::input_error_of;
using test::refusal;
using ::testing::HasSubstr;

TEST(Configure, RefusesKeysThatTheDecisionIgnores) {
  EXPECT_THAT(refusal("front_end:\n  decision: {method: inliers, max_false_alarms: 0.1}\n"),
              HasSubstr("config.yaml:2: front_end.decision.max_false_alarms: "
                        "front_end.decision.method inliers has no use for it and would ignore it"));
  EXPECT_THAT(
      refusal("front_end: {ransac: {score: paper}}\n"),
      HasSubstr(
          "front_end.ransac.score: front_end.decision.method false_alarms has no use for it"));
  const std::string limit = "front_end.decision.max_false_alarms";
  const std::string score = "front_end.ransac.score";
  const Configuration usual = configured("front_end: {decision: {max_false_alarms: 1.0e-5}}\n");
  EXPECT_EQ(in_force(usual, limit), "1e-05");
  EXPECT_EQ(in_force(usual, score), "(none)");
  const Configuration paper =
      configured("front_end: {decision: {method: inliers}, ransac: {score: paper}}\n");
  EXPECT_EQ(in_force(paper, limit), "(none)");
  EXPECT_EQ(in_force(paper, score), "paper");
}

TEST(Configure, TunedNumbersOfTheRegistrationAreKeys) {
  const std::string key = "front_end.registration_tuning.covariance.shared_error";
  const std::string set = "registration_tuning: {covariance: {shared_error: 0.05}}";
  EXPECT_EQ(in_force(configured(""), key), "0.055");
  const Configuration changed = configured("front_end: {" + set + "}\n");
  EXPECT_EQ(changed.front_end.registration.tuning.covariance.shared_error, 0.05);
  EXPECT_EQ(in_force(changed, key), "0.05");
  const std::string gate = "registration_tuning: {fit: {gate: 9}}";
  EXPECT_THAT(
      refusal("front_end: {decision: {method: inliers}, " + gate + "}\n"),
      HasSubstr(
          "registration_tuning.fit.gate: front_end.decision.method inliers has no use for it"));
  const std::string window = "registration_tuning: {features: {window_px: 9}}";
  EXPECT_THAT(refusal("front_end: {features: {flatten: false}, " + window + "}\n"),
              HasSubstr("window_px: front_end.features.flatten false has no use for it"));
}

TEST(Configure, RefusesKeysThatTheOdometryIgnores) {
  EXPECT_THAT(refusal("dataset:\n  odometry: {source: visual_odometry, correlated_share: 0.5}\n"),
              HasSubstr("config.yaml:2: dataset.odometry.correlated_share: "
                        "dataset.odometry.source visual_odometry has no use for it"));
  EXPECT_THAT(refusal("dataset: {odometry: {correlation_length_m: 3}}\n"),
              HasSubstr("dataset.odometry.correlation_length_m: "
                        "dataset.odometry.correlated_share 0 has no use for it"));
  EXPECT_EQ(in_force(configured("dataset: {odometry: {correlated_share: 0.5}}\n"),
                     "dataset.odometry.correlation_length_m"),
            "2");
}

TEST(Configure, RefusesKeysThatTheCandidatesMethodIgnores) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"{method: distance, max_distance_m: 2, probability: 0.9}",
       "candidates.probability: front_end.candidates.method distance has no use"},
      {"{max_distance_m: 2, min_overlap: 0.9}",
       "candidates.min_overlap: front_end.candidates.max_distance_m 2 has no use"},
      {"{max_distance_m: 2, budget: 9}",
       "candidates.budget: front_end.candidates.max_distance_m 2 has no use"},
      {"{method: mahalanobis, max_distance_m: 2, min_overlap: 0.9}",
       "candidates.method mahalanobis has no use"},
      {"{method: possible_overlap, max_distance_m: 2}",
       "candidates.max_distance_m: front_end.candidates.method possible_overlap has no use"},
      {"{max_per_keyframe: 2}",
       "candidates.max_per_keyframe: front_end.candidates.method automatic has no use"},
      {"{method: distance}",
       "config.yaml:2: front_end.candidates.method: this one needs candidates.max_distance_m"},
      {"{method: overlap, max_distance_m: 2}",
       "candidates.max_distance_m: front_end.candidates.method"},
      {"{method: overlap, probability: 0.9}", "candidates.method overlap has no use"}};
  for (const auto& [candidates, message] : cases) {
    EXPECT_THAT(input_error_of([&, &text = candidates] {
                  configured("front_end:\n  candidates: " + text + "\n");
                }),
                HasSubstr(message));
  }
}

TEST(Configure, InForceAreTheKeysOfTheCandidatesMethod) {
  const std::string prefix = "front_end.candidates.";
  const Configuration overlap = configured(
      "front_end: {candidates: {method: overlap, min_overlap: 0.4, max_per_keyframe: 7}}\n");
  EXPECT_EQ(overlap.front_end.candidates.method, CandidateMethod::overlap);
  EXPECT_EQ(overlap.front_end.candidates.max_per_keyframe, 7);
  EXPECT_EQ(in_force(overlap, prefix + "min_overlap"), "0.4");
  EXPECT_EQ(in_force(overlap, prefix + "max_distance_m"), "(none)");
  EXPECT_EQ(in_force(configured(""), prefix + "max_distance_m"), "off");
  EXPECT_EQ(in_force(configured(""), prefix + "max_per_keyframe"), "(none)");
  EXPECT_EQ(in_force(configured(""), prefix + "probability"), "0.99");
  const Configuration distance = configured("front_end: {candidates: {max_distance_m: 2}}\n");
  EXPECT_EQ(in_force(distance, prefix + "max_per_keyframe"), "off");
  EXPECT_EQ(in_force(distance, prefix + "probability"), "(none)");
}

// What is given in metres takes the place of what scales.
TEST(Configure, RefusesWhatAKeyInMetresLeavesWithoutEffect) {
  EXPECT_THAT(refusal("front_end: {ransac: {max_error_m: 0.1, max_error_px: 3}}\n"),
              HasSubstr("max_error_px: front_end.ransac.max_error_m 0.1 has no use for it"));
  EXPECT_THAT(refusal("front_end: {keyframes: {separation_frames: 2, min_overlap: 0.5}}\n"),
              HasSubstr("min_overlap: front_end.keyframes.separation_frames 2 has no use for it"));
  EXPECT_THAT(refusal("front_end: {visual_odometry: {fallback_sigma_m: 1, "
                      "fallback_sigma_altitudes: 1}}\n"),
              HasSubstr("fallback_sigma_altitudes: front_end.visual_odometry.fallback_sigma_m 1"));
}

TEST(Configure, RefusesKeysThatTheMissionIgnores) {
  EXPECT_THAT(refusal("dataset:\n  mission: {type: sweep, loop_length_m: 3}\n"),
              HasSubstr("config.yaml:2: dataset.mission.loop_length_m: dataset.mission.type sweep "
                        "has no use for it and would ignore it"));
  EXPECT_THAT(refusal("dataset: {mission: {legs: 2, type: single_loop}}\n"),
              HasSubstr("dataset.mission.legs: dataset.mission.type single_loop has no use"));
  EXPECT_THAT(refusal("dataset: {mission: {waypoints_m: [0, 0, 1, 1]}}\n"),
              HasSubstr("dataset.mission.waypoints_m: dataset.mission.type sweep has no use"));
  const Configuration loop = configured("dataset.mission.type: single_loop\n");
  EXPECT_EQ(in_force(loop, "dataset.mission.loop_length_m"), "10");
  EXPECT_EQ(in_force(loop, "dataset.mission.legs"), "(none)");
}

}  // namespace
}  // namespace fathom
