#include "fathom/configuration/configuration.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::configured;
using test::in_force;
using test::input_error_of;
using test::kSingle;
using test::refusal;
using test::settings_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Configure, NothingGivenIsAllDefaults) {
  const Configuration configuration = configured("");
  EXPECT_EQ(configuration.dataset.type, "simulated");
  EXPECT_TRUE(configuration.dataset.values.empty());
  EXPECT_EQ(configuration.seed, Configuration{}.seed);
  EXPECT_EQ(configuration.front_end.keyframes.separation_frames,
            FrontEndOptions{}.keyframes.separation_frames);
  ASSERT_EQ(configuration.estimators.size(), 1u);
  EXPECT_EQ(configuration.estimators[0].type, builtin_estimators().entries().front().name);
  EXPECT_TRUE(configuration.estimators[0].values.empty());
}

TEST(Configure, SetsEveryLevel) {
  const Configuration configuration = configured(
      "seed: 42\n"
      "evaluation: {alignment: se2}\n"
      "dataset:\n"
      "  type: simulated\n"
      "  mission: {type: waypoints, waypoints_m: [[0, 0], [5, 0], [5, 4]]}\n"
      "  camera: {cx: 310.5}\n"
      "front_end:\n"
      "  keyframes: {separation_frames: 4}\n"
      "  features: {type: orb, clahe: true}\n"
      "  ransac: {score: paper, max_error_m: 0.05}\n"
      "  decision: {method: inliers}\n"
      "estimator: {type: ekf, gate_probability: 0.99}\n");
  EXPECT_EQ(configuration.seed, 42);
  EXPECT_EQ(configuration.study.evaluation.alignment, Alignment::se2);
  const auto simulation = options_of<SimulatedSurveyOptions>(configuration.dataset.values);
  EXPECT_EQ(simulation.mission.type, MissionType::kWaypoints);
  EXPECT_THAT(simulation.mission.waypoints_m, ElementsAre(0, 0, 5, 0, 5, 4));
  EXPECT_EQ(simulation.camera.cx, 310.5);
  EXPECT_EQ(configuration.front_end.keyframes.separation_frames, 4);
  EXPECT_EQ(configuration.front_end.features.type, "orb");
  EXPECT_TRUE(configuration.front_end.features.clahe);
  EXPECT_EQ(configuration.front_end.registration.ransac.score, RansacScore::paper);
  EXPECT_EQ(configuration.front_end.registration.ransac.max_error_m, 0.05);
  EXPECT_EQ(configuration.estimators[0].type, "ekf");
  EXPECT_THAT(configuration.estimators[0].values.at("gate_probability").items, ElementsAre("0.99"));
}

TEST(Configure, KnowsTheKeysThatEveryConfigurationShares) {
  const Configuration configuration = configured("");
  for (const std::string key :
       {"dataset.type", "front_end.keyframes.separation_frames",
        "front_end.candidates.max_distance_m", "front_end.features.type",
        "front_end.matching.ratio", "front_end.matching.mutual", "front_end.ransac.iterations",
        "front_end.ransac.sample_size", "front_end.ransac.max_error_m",
        "front_end.ransac.min_inliers", "front_end.features.flatten", "front_end.decision.method",
        "front_end.decision.max_false_alarms", "front_end.covariance.altitude_sigma_m",
        "front_end.covariance.tilt_sigma_rad", "front_end.covariance.floor_sigma_m",
        "front_end.covariance.floor_sigma_rad", "seed"}) {
    EXPECT_NE(in_force(configuration, key), "(none)") << key;
  }
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    for (const std::string key : {"max_iterations", "tolerance", "gate_probability"}) {
      EXPECT_TRUE(std::any_of(entry.options.begin(), entry.options.end(),
                              [&](const OptionDescription& o) { return o.key == key; }))
          << entry.name << " " << key;
    }
  }
}

TEST(Configure, WhatIsInForceReadsBack) {
  const Configuration first = configured(
      "seed: 3\ndataset: {mission: {type: waypoints, waypoints_m: [0, 0, 1, 1]}, altitude: "
      "{base_m: 1.7}}\n"
      "front_end: {matching: {ratio: 0.1}}\n");
  EXPECT_EQ(in_force(first, "seed"), "3");
  EXPECT_EQ(in_force(first, "front_end.matching.ratio"), "0.1");
  std::string text;
  for (const auto& [key, value] : first.in_force) {
    text += key + ": " + (value.empty() ? "''" : value) + "\n";
  }
  EXPECT_EQ(configured(text).in_force, first.in_force);
}

TEST(Configure, RefusesUnknownKeysAtEveryLevelWithTheNearest) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"sed: 1\n", "config.yaml:1: unknown key 'sed'; did you mean 'seed'?"},
      {"front_end:\n  ransac:\n    iteration: 5\n",
       "config.yaml:3: unknown key 'front_end.ransac.iteration'; did you mean "
       "'front_end.ransac.iterations'?"},
      {"front_end: {matchin: {ratio: 1}}\n", "did you mean 'front_end.matching.ratio'?"},
      {"dataset: {altitude: {base: 2}}\n", "did you mean 'dataset.altitude.base_m'?"},
      {"dataset: {tpye: g2o}\n", "did you mean 'dataset.type'?"},
      {"estimator: {max_iteration: 2}\n",
       "config.yaml:1: unknown key 'estimator.max_iteration' of trajectory_iekf; did you mean "
       "'estimator.max_iterations'?"},
      {"estimator: {typ: ekf}\n", "did you mean 'estimator.type'?"},
      {"estimator: {type: ekff}\n", "config.yaml:1: estimator.type: "},
      {"estimator: {type: ekff}\n", "did you mean 'ekf'?"},
      {"estimater: {type: ekf}\n", "did you mean 'estimator.type'?"},
      {"seed.x: 1\n", "unknown key 'seed.x'"},
      {"front_end: 3\n", "config.yaml:1: front_end: expected a map of keys, such as 'front_end."},
      {"front_end: {ransac: [1]}\n", "config.yaml:1: front_end.ransac: expected a map of keys"},
      {"qqqqqqqqqqqq: 1\n", "unknown key 'qqqqqqqqqqqq'"}};
  for (const auto& [text, message] : cases) EXPECT_THAT(refusal(text), HasSubstr(message));
}

TEST(Configure, AnOptionOfAnotherEstimatorIsUnknown) {
  EXPECT_THAT(refusal("estimator: {type: ekf, loss: huber}\n"),
              HasSubstr("unknown key 'estimator.loss' of ekf"));
  EXPECT_NO_THROW(configured("estimator: {type: ceres_pose_graph, loss: huber}\n"));
}

TEST(Configure, RefusesWrongTypesAndRangesWithTheBound) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"seed: x\n", "config.yaml:1: seed: expected a whole number >= 0, <= 2147483647, got 'x'"},
      {"seed: 1.5\n", "got '1.5'"},
      {"seed: -1\n", "got '-1'"},
      {"seed: 99999999999\n", "got '99999999999'"},
      {"seed: 99999999999999999999999\n", "seed: expected a whole number"},
      {"seed: [1]\n", "got '[1]'"},
      {"seed: ''\n", "got ''"},
      {"front_end: {matching: {ratio: nan}}\n", "front_end.matching.ratio: expected a number"},
      {"front_end: {matching: {ratio: .inf}}\n", "front_end.matching.ratio: expected a number"},
      {"front_end: {matching: {mutual: maybe}}\n", "expected true or false, got 'maybe'"},
      {"front_end: {ransac: {max_error_m: 0}}\n", "expected a number in m > 0 or off, got '0'"},
      {"front_end: {keyframes: {separation_frames: 0}}\n", "expected a whole number >= 1"},
      {"front_end: {features: {type: surf}}\n", "expected one of sift, orb, akaze, brisk"},
      {"dataset: {altitude: {base_m: -2}}\n", "expected a number in m > 0, got '-2'"},
      {"dataset: {odometry: {covariance: [1, 2, 3]}}\n", "a multiple of 6 numbers"},
      {"dataset: {odometry: {covariance: [1, 2, 3, 4, 5, x]}}\n", "expected a list of numbers"},
      {"dataset: {type: video}\n",
       "expected one of simulated, image_folder, pictures, g2o, simulated_log, got 'video'"},
      {"evaluation: {alignment: sim3}\n", "expected one of none, origin, se2, got 'sim3'"},
      {"estimator: {max_iterations: 0}\n",
       "estimator.max_iterations: expected a whole number >= 1"},
      {"estimator: {gate_probability: 1}\n", "estimator.gate_probability: expected a number"},
      {"estimator: {type: [ekf]}\n", "config.yaml:1: estimator.type: expected a single word"},
      {"estimator: ekf\n", "expected a map, such as 'estimator: {type: ekf}'"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(refusal(text), HasSubstr(message));
    EXPECT_THAT(refusal(text), HasSubstr("config.yaml:1: "));
  }
}

TEST(Configure, TheTypeOfTheDataSetSaysWhichKeysThereAre) {
  const auto folder = configured("dataset: {path: a, type: image_folder}\n").dataset;
  EXPECT_EQ(folder.type, "image_folder");
  EXPECT_THAT(folder.values.at("path").items, ElementsAre("a"));
  EXPECT_THAT(refusal("dataset: {type: g2o, mission: {legs: 2}}\n"),
              HasSubstr("unknown key 'dataset.mission.legs'"));
  EXPECT_THAT(refusal("dataset: {path: a}\n"), HasSubstr("unknown key 'dataset.path'"));
}

TEST(Configure, ListsTheDataSetsWithTheirOptions) {
  std::set<std::string> names;
  for (const DataSetEntry& entry : data_sets()) {
    names.insert(entry.name);
    EXPECT_FALSE(entry.options.empty());
    std::set<std::string> ignored;
    for (const IgnoredKey& one : entry.make_options()->ignored_keys()) ignored.insert(one.key);
    std::string text = "dataset.type: " + entry.name + "\n";
    for (const OptionDescription& option : entry.options) {
      if (ignored.contains(option.key)) continue;
      const std::string value = option.default_value.empty() ? "''" : option.default_value;
      text += "dataset." + option.key + ": " + value + "\n";
    }
    EXPECT_NO_THROW(configured(text)) << text;
  }
  EXPECT_THAT(names, ElementsAre("g2o", "image_folder", "pictures", "simulated", "simulated_log"));
}

TEST(Configure, AnOverrideNamesItselfInItsError) {
  Settings settings = settings_of("seed: 1\n");
  settings.put(parse_override("front_end.matching.ratio=2x"));
  EXPECT_THAT(input_error_of([&] { configure(settings, kSingle, builtin_estimators()); }),
              HasSubstr("--set front_end.matching.ratio=2x: front_end.matching.ratio: expected"));
}

}  // namespace
}  // namespace fathom
