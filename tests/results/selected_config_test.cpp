#include "fathom/results/selected_config.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "harness/small_study.hpp"

namespace fathom {
namespace {

using test::configured;
using test::described_study;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// The place of the estimator, and of the cells looked at.
Selection chosen(std::size_t estimator, const StudyDescription& study,
                 std::vector<std::size_t> cells) {
  Selection selection;
  selection.cells = std::move(cells);
  selection.cells_asked = selection.cells.size();
  selection.fewest_trials = selection.most_trials = 20;
  selection.repeats = "1 survey × 20 trials";
  for (const StudyEstimator& described : study.estimators) {
    EstimatorEvidence evidence;
    evidence.name = described.name;
    evidence.objective = TrialMean{20, 12.3, Interval{12.0, 12.7}};
    selection.estimators.push_back(evidence);
  }
  selection.chosen = estimator;
  return selection;
}

std::string config_of(const std::string& study, std::size_t estimator,
                      std::vector<std::size_t> cells) {
  const StudyDescription described = described_study(study);
  SelectionQuery query;
  query.requirements = {parse_requirement("mean_position_error_m<=0.1")};
  return selected_configuration(described, chosen(estimator, described, std::move(cells)), query,
                                builtin_estimators());
}

std::map<std::string, std::string> in_force(const Configuration& configuration) {
  return {configuration.in_force.begin(), configuration.in_force.end()};
}

constexpr const char* kStudy = R"(
report: {title: 'What noise does'}
trials: 20
seed: 7
association: {mode: own}
evaluation: {alignment: se2, rpe_keyframes: [1, 5], min_overlap: 0.4}
dataset:
  mission: {type: waypoints, waypoints_m: [0, 0, 5, 0]}
  camera: {distortion: [-0.05, 0.01, 0.001, -0.001, 0]}
front_end:
  features.type: orb
  ransac: {max_error_m: 0.05, min_inliers: 20}
estimators:
  - {type: trajectory_iekf, name: filter, gate_probability: 0.9999, max_iterations: 3}
  - {type: ceres_pose_graph, name: graph}
)";

TEST(SelectedConfiguration, IsARunWithTheValuesOfTheStudy) {
  const std::string text = config_of(kStudy, 0, {0});
  const Configuration run = configured(text);
  const Configuration study = configured(kStudy, ConfigurationKind::comparison);
  const auto of_study = in_force(study);
  for (const auto& [key, value] : run.in_force) EXPECT_EQ(of_study.at(key), value) << key;
  ASSERT_EQ(run.estimators.size(), 1u);
  EXPECT_EQ(run.estimators[0].type, "trajectory_iekf");
  ASSERT_EQ(run.estimators[0].values.size(), 2u) << text;
  EXPECT_EQ(run.estimators[0].values.at("gate_probability").items.front(), "0.9999");
  EXPECT_EQ(run.estimators[0].values.at("max_iterations").items.front(), "3");
}

TEST(SelectedConfiguration, SaysHowItWasChosenAndNoMoreThanItNeeds) {
  EXPECT_EQ(
      config_of(kStudy, 1, {0}),
      R"(# graph, chosen by 'fathom select' from the study 'What noise does': cells 1; each 1 survey × 20 trials
# It meets mean_position_error_m <= 0.1 in every cell;
# least total_ms: 12.3 [12, 12.7], 95 % of the mean
dataset:
  type: simulated
  mission: {type: waypoints, waypoints_m: [0, 0, 5, 0]}
  camera: {distortion: [-0.05, 0.01, 0.001, -0.001, 0]}
front_end:
  features: {type: orb}
  ransac: {max_error_m: 0.05, min_inliers: 20}
estimator:
  type: ceres_pose_graph
seed: 7
evaluation:
  alignment: se2
)");
}

TEST(SelectedConfiguration, DefaultsLeaveTheTypesAlone) {
  const std::string text = config_of("trials: 2\n", 0, {0});
  EXPECT_THAT(text, HasSubstr("dataset:\n  type: simulated\nestimator:\n  type: "));
  EXPECT_EQ(in_force(configured(text)), in_force(configured("")));
}

constexpr const char* kSweep = R"(
dataset: {odometry: {sigma_x_m: 0.02}}
estimators:
  - {type: trajectory_iekf, name: filter}
  - {type: ceres_pose_graph, name: graph}
sweep:
  - {key: front_end.keyframes.separation_frames, name: separation, values: [5, 10]}
  - {key: dataset.camera.distortion, name: lens, labels: [bent, straight],
     values: [[-0.05, 0.01, 0, 0, 0], [0, 0, 0, 0, 0]]}
  - {key: estimators.0.max_iterations, name: limit, values: [1, 4]}
)";

TEST(SelectedConfiguration, ASweptKeyHasTheValueOfTheCellsLookedAt) {
  // Separation 10, straight lens, 1 and 4 iterations.
  const std::string text = config_of(kSweep, 0, {6, 7});
  const auto values = in_force(configured(text));
  EXPECT_EQ(values.at("front_end.keyframes.separation_frames"), "10");
  EXPECT_EQ(values.at("dataset.camera.distortion"), "[0, 0, 0, 0, 0]");
  EXPECT_EQ(values.at("dataset.odometry.sigma_x_m"), "0.02");
  EXPECT_THAT(text, HasSubstr("keyframes.separation_frames: 10  # swept in the study\n"));
  EXPECT_THAT(text, HasSubstr("max_iterations: 1  # the first of those looked at: 1, 4\n"));
  const std::string all = config_of(kSweep, 1, {0, 1, 2, 3, 4, 5, 6, 7});
  EXPECT_EQ(in_force(configured(all)).at("front_end.keyframes.separation_frames"), "5");
  EXPECT_EQ(in_force(configured(all)).at("dataset.camera.distortion"), "[-0.05, 0.01, 0, 0, 0]");
  EXPECT_THAT(all, HasSubstr("# the first of those looked at: bent, straight\n"));
  EXPECT_THAT(all, Not(HasSubstr("max_iterations")));
}

TEST(SelectedConfiguration, ASweptTypeBringsNoDefaultsOfAnother) {
  const char* const study = R"(
estimators: [{name: one}]
sweep:
  - {key: estimators.0.type, values: [ceres_pose_graph, trajectory_iekf]}
)";
  const Configuration run = configured(config_of(study, 0, {1}));
  EXPECT_EQ(run.estimators[0].type, "trajectory_iekf");
  EXPECT_TRUE(run.estimators[0].values.empty());
}

TEST(SelectedConfiguration, HasTheKeysOfTheCandidatesMethodAlone) {
  const std::string text =
      config_of("front_end.candidates: {method: overlap, min_overlap: 0.4}\n", 0, {0});
  const Configuration overlap = configured(text);
  EXPECT_EQ(overlap.front_end.candidates.method, CandidateMethod::overlap);
  EXPECT_EQ(overlap.front_end.candidates.min_overlap, 0.4);
  EXPECT_THAT(text, Not(HasSubstr("max_distance_m")));
  const char* const swept = R"(
front_end.candidates: {max_distance_m: 1.2}
sweep:
  - {key: front_end.candidates.method, values: [distance, mahalanobis]}
)";
  const Configuration second = configured(config_of(swept, 0, {1}));
  EXPECT_EQ(second.front_end.candidates.method, CandidateMethod::mahalanobis);
  EXPECT_EQ(second.front_end.candidates.max_distance_m, 1.2);
}

TEST(SelectedConfiguration, KeysOfAComparisonMayBeSweptAndAreLeftOut) {
  const char* const study = R"(
sweep:
  - {key: association.mode, values: [own, shared]}
  - {key: seed, values: [3, 4]}
)";
  const Configuration run = configured(config_of(study, 0, {2, 3}));
  EXPECT_EQ(run.seed, 3);
  EXPECT_EQ(configured(config_of(study, 0, {1, 3})).seed, 4);
}

TEST(SelectedConfiguration, HasTheKeysOfTheStudysMission) {
  const std::string mission =
      "dataset: {mission: {type: single_loop, loop_length_m: 3, loop_width_m: 2}}\n";
  const StudyDescription study = described_study(mission);
  const Configuration run =
      configured(selected_configuration(study, chosen(0, study, {0}), {}, builtin_estimators()));
  EXPECT_EQ(in_force(run).at("dataset.mission.loop_length_m"), "3");
  EXPECT_EQ(in_force(run).at("dataset.mission.loop_width_m"), "2");
}

TEST(SelectedConfiguration, PathsSurviveWhateverTheyHold) {
  for (const std::string path : {"a b/it's: #1", "null", "say \"x\"\\n", "[x", "a,{b}", "-"}) {
    StudyDescription study = described_study("dataset: {type: image_folder, path: x}\n");
    for (auto& [key, value] : study.configuration) {
      if (key == "dataset.path") value = path;
    }
    const std::string text =
        selected_configuration(study, chosen(0, study, {0}), {}, builtin_estimators());
    const Configuration run = configured(text);
    EXPECT_EQ(run.dataset.type, "image_folder");
    EXPECT_THAT(run.dataset.values.at("path").items, ElementsAre(path)) << text;
  }
}

}  // namespace
}  // namespace fathom
