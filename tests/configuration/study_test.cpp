#include "fathom/configuration/study.hpp"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/simulated_survey.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Settings settings_of(const std::string& text) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "study.yaml") << text;
  return read_settings(folder / "study.yaml");
}

Study study_of(const std::string& text) {
  return configure_study(settings_of(text), builtin_estimators());
}

std::string refusal(const std::string& text) {
  return input_error_of([&] { study_of(text); });
}

std::string value_of(const Study& study, const std::string& key) {
  for (const auto& [name, value] : study.description.configuration) {
    if (name == key) return value;
  }
  return "(absent)";
}

TEST(ConfigureStudy, WithoutASweepThereIsOneCell) {
  const Study study = study_of("trials: 7\nseed: 3\nestimators: [{type: ekf}]\n");
  EXPECT_EQ(study.cells.size(), 1u);
  EXPECT_EQ(study.description.trials, 7u);
  EXPECT_THAT(study.noise_seeds, ElementsAre(3u));
  ASSERT_EQ(study.description.estimators.size(), 1u);
  EXPECT_EQ(study.description.estimators[0].type, "ekf");
  EXPECT_EQ(value_of(study, "association.mode"), "shared");
  EXPECT_EQ(value_of(study, "estimators.0.gate_probability"), "off");
  // What results do not depend on may change between sessions.
  EXPECT_EQ(value_of(study, "trials"), "(absent)");
  EXPECT_EQ(value_of(study, "jobs"), "(absent)");
  EXPECT_EQ(value_of(study, "report.title"), "(absent)");
}

TEST(ConfigureStudy, ASweepMultipliesItsAxesOverAnyKey) {
  const Study study = study_of(R"(
estimators: [{type: trajectory_iekf}]
sweep:
  - {key: front_end.keyframes.separation_frames, name: separation, values: [5, 10]}
  - key: dataset.odometry.covariance
    labels: [none, full, some]
    values: [[1, 0, 0, 1, 0, 1], [2, 0.5, 0, 2, 0, 1], [3, 0, 0, 3, 0, 1]]
  - {key: estimators.0.max_iterations, values: [1, 10]}
)");
  ASSERT_EQ(study.cells.size(), 12u);
  EXPECT_EQ(study.description.label_of(9), "separation 10, covariance full, max_iterations 10");
  EXPECT_EQ(study.cells[9].front_end.separation_frames, 10);
  EXPECT_THAT(options_of<SimulatedSurveyOptions>(study.cells[9].dataset.values).odometry.covariance,
              ElementsAre(2, 0.5, 0, 2, 0, 1));
  EXPECT_EQ(study.cells[9].estimators[0].values.at("max_iterations").items.front(), "10");
  EXPECT_EQ(study.cells[8].estimators[0].values.at("max_iterations").items.front(), "1");
  EXPECT_EQ(value_of(study, "front_end.keyframes.separation_frames"), "(absent)");
  EXPECT_EQ(value_of(study, "sweep.1.values"),
            "[[1, 0, 0, 1, 0, 1], [2, 0.5, 0, 2, 0, 1], [3, 0, 0, 3, 0, 1]]");
}

TEST(ConfigureStudy, ACellsNoiseDoesNotDependOnTheOtherCells) {
  const auto seeds = [](const std::string& values) {
    return study_of("sweep: [{key: front_end.candidates.max_distance_m, values: " + values + "}]\n")
        .noise_seeds;
  };
  const auto two = seeds("[1, 2]");
  const auto three = seeds("[3, 2, 1]");
  EXPECT_NE(two[0], two[1]);
  EXPECT_EQ(two[0], three[2]);
  EXPECT_EQ(two[1], three[1]);
}

TEST(ConfigureStudy, RefusesWhatIsNoSweep) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"sweep: 3\n", "study.yaml:1: sweep: expected a list of axes"},
      {"sweep: [{values: [1]}]\n", "sweep.0.key is missing"},
      {"sweep: [{key: seed}]\n", "sweep.0.values is missing"},
      {"sweep: [{key: seed, values: 3}]\n", "sweep.0.values: expected a list"},
      {"sweep: [{key: seed, values: []}]\n", "sweep.0.values: expected a list"},
      {"sweep: [{key: seed, values: [1, 2, 1]}]\n", "'1' is given twice"},
      {"sweep: [{key: seed, value: [1]}]\n", "did you mean 'values'?"},
      {"sweep: [{key: seed, values: [1, 2], labels: [a]}]\n", "expected one for each of the 2"},
      {"sweep: [{key: seeed, values: [1]}]\n", "unknown key 'seeed'; did you mean 'seed'?"},
      {"sweep: [{key: seed, values: [x]}]\n", "study.yaml:1: seed: expected a whole number"},
      {"sweep: [{key: trials, values: [1]}]\n", "trials is the study's own"},
      {"sweep: [{key: report.title, values: [1]}]\n", "report.title is the study's own"},
      {"sweep: [{key: seed, values: [1]}, {key: seed, values: [2]}]\n", "two axes are 'seed'"},
      {"seed: 4\nsweep: [{key: seed, values: [1]}]\n",
       "study.yaml:1: seed: is swept, so this value would go unread; change sweep.0.values"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.max_iteration, values: [1]}]\n",
       "did you mean 'estimators.0.max_iterations'?"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.1.type, values: [ekf]}]\n",
       "two estimators are called 'ekf'"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.name, values: [a, b]}]\n",
       "names change from cell to cell"},
      {"estimators: [{type: ekf, tolerance: 1}]\n",
       "study.yaml:1: estimators.0.tolerance: ekf has no use for it and would ignore it"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.max_iterations, values: [1, 5]}]\n",
       "estimators.0.max_iterations: ekf has no use for it"},
      {"trials: 0\n", "trials: expected a whole number"},
      {"evaluation: {rpe_keyframes: [1.5]}\n", "evaluation.rpe_keyframes: expected whole numbers"},
      {"evaluation: {rpe_distances_m: [0]}\n", "evaluation.rpe_distances_m: expected numbers in m"},
      {"association: {mode: own, reference: ekf}\n",
       "study.yaml:1: association.reference: nobody's estimate but each one's own picks the loop "
       "candidates"},
      {"estimators: [{type: ekf, name: dead_reckoning}]\n", "is the baseline of every table"}};
  for (const auto& [text, message] : cases) EXPECT_THAT(refusal(text), HasSubstr(message)) << text;
}

TEST(ConfigureStudy, AGraphHasNoNoiseToDraw) {
  const std::string graph = "dataset: {type: g2o, path: a.g2o}\n";
  EXPECT_THAT(refusal(graph + "trials: 2\n"),
              HasSubstr("trials: a pose graph without false loops"));
  EXPECT_THAT(refusal(graph + "association: {mode: own}\n"),
              HasSubstr("association.mode: a pose graph has its loops"));
  EXPECT_EQ(study_of(graph).cells.size(), 1u);
}

TEST(WithoutSweep, LeavesTheRest) {
  const Settings settings =
      without_sweep(settings_of("seed: 4\nsweep: [{key: trials, values: [1]}]\n"));
  ASSERT_EQ(settings.all().size(), 1u);
  EXPECT_EQ(settings.all().front().key, "seed");
}

}  // namespace
}  // namespace fathom
