#include "fathom/configuration/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/study_of.hpp"
#include "fathom/core/random.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"

namespace fathom {
namespace {

using test::refusal_of_study;
using test::settings_of;
using test::study_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

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
  EXPECT_EQ(study.description.surveys, 1u);
  EXPECT_EQ(value_of(study, "surveys"), "(absent)");
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
  EXPECT_EQ(study.description.label_of(9), "separation 10, covariance full, max iterations 10");
  EXPECT_EQ(study.cells[9].front_end.keyframes.separation_frames, 10);
  EXPECT_THAT(options_of<SimulatedSurveyOptions>(study.cells[9].dataset.values).odometry.covariance,
              ElementsAre(2, 0.5, 0, 2, 0, 1));
  EXPECT_EQ(study.cells[9].estimators[0].values.at("max_iterations").items.front(), "10");
  EXPECT_EQ(study.cells[8].estimators[0].values.at("max_iterations").items.front(), "1");
  EXPECT_EQ(value_of(study, "front_end.keyframes.separation_frames"), "(absent)");
  EXPECT_EQ(value_of(study, "sweep.1.values"),
            "[[1, 0, 0, 1, 0, 1], [2, 0.5, 0, 2, 0, 1], [3, 0, 0, 3, 0, 1]]");
}

TEST(ConfigureStudy, KnowsWhoConsidersSharedErrors) {
  const StudyDescription study = study_of(R"(
estimators: [{type: ekf}, {type: ekf, name: swept}, {type: sparse_gauss_newton}]
sweep: [{key: estimators.1.shared_errors, values: [states, consider]}]
)")
                                     .description;
  EXPECT_TRUE(study.considers_shared_errors(0, "ekf"));
  EXPECT_FALSE(study.considers_shared_errors(0, "swept"));
  EXPECT_TRUE(study.considers_shared_errors(1, "swept"));
  EXPECT_FALSE(study.considers_shared_errors(0, "sparse_gauss_newton"));
  EXPECT_FALSE(study.considers_shared_errors(0, kDeadReckoning));
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

// Seeds of the values as the shipped studies write them: 1.0e-5, 1.25e-4, 0.01.
TEST(ConfigureStudy, NoiseIsSeededByValuesAndNotBySpellings) {
  const auto seeds = [](const std::string& key, const std::string& values) {
    return study_of("sweep: [{key: " + key + ", values: " + values + "}]\n").noise_seeds;
  };
  const std::string distance = "front_end.candidates.max_distance_m";
  EXPECT_EQ(seeds(distance, "[0.01, 1.0e-5, 1.25e-4, 12]"),
            seeds(distance, "[1e-2, 0.00001, 0.125e-3, 12.0]"));
  EXPECT_EQ(seeds(distance, "[0.01]")[0], stream_seed(1, distance + "=0.01,;", 0));
  EXPECT_EQ(seeds(distance, "[0.00001]")[0], stream_seed(1, distance + "=1.0e-5,;", 0));
  EXPECT_EQ(seeds(distance, "[0.00122]")[0], stream_seed(1, distance + "=1.22e-3,;", 0));
  EXPECT_EQ(seeds("dataset.odometry.covariance", "[[1e-5, 0.0, 0, 0.00001, 0, 1e-4]]")[0],
            stream_seed(1, "dataset.odometry.covariance=1.0e-5,0,0,1.0e-5,0,1.0e-4,;", 0));
  EXPECT_EQ(seeds("front_end.features.type", "[orb]")[0],
            stream_seed(1, "front_end.features.type=orb,;", 0));
}

TEST(ConfigureStudy, TwoSpellingsOfOneValueAreRefused) {
  const std::string sweep = "sweep: [{key: front_end.candidates.max_distance_m, values: ";
  EXPECT_THAT(refusal_of_study(sweep + "[0.01, 1e-2]}]\n"),
              HasSubstr("config.yaml:1: sweep.0.values: '0.01' and '1e-2' are the same value"));
  EXPECT_THAT(refusal_of_study(sweep + "[0.01, 1e-2], labels: [a, b]}]\n"),
              HasSubstr("'a' and 'b' are the same value"));
  EXPECT_NO_THROW(
      study_of("dataset.type: image_folder\n"
               "sweep: [{key: dataset.path, values: [0.01, 1e-2]}]\n"));
}

TEST(ConfigureStudy, ItsIdentityIsOfValuesAndNotOfSpellingsOrLabels) {
  const auto identity = [](const std::string& tolerance, const std::string& axis) {
    return study_of("estimators: [{type: trajectory_iekf, tolerance: " + tolerance +
                    "}]\nsweep: [{key: front_end.candidates.max_distance_m, " + axis + "}]\n")
        .description.configuration;
  };
  const auto plain = identity("1e-5", "values: [1, 0.001]");
  EXPECT_EQ(identity("0.00001", "values: [1.0, 1.0e-3]"), plain);
  EXPECT_EQ(identity("1e-5", "name: far, values: [1, 0.001], labels: [one, two]"), plain);
  EXPECT_NE(identity("1e-4", "values: [1, 0.001]"), plain);
  EXPECT_NE(identity("1e-5", "values: [1, 0.002]"), plain);
}

TEST(ConfigureStudy, ATextForTheTablesIsShortAndNoOtherColumn) {
  const auto named = [](const std::string& name) {
    return refusal_of_study("sweep: [{key: seed, name: " + name + ", values: [1, 2]}]\n");
  };
  EXPECT_THAT(named("trial"), HasSubstr("config.yaml:1: sweep.0.name: 'trial' is another column of "
                                        "the tables; give the axis another name"));
  EXPECT_THAT(named("estimator"), HasSubstr("is another column"));
  EXPECT_THAT(named("association"), HasSubstr("is another column"));
  EXPECT_THAT(named("keyframes"), HasSubstr("is another column"));
  EXPECT_NO_THROW(
      study_of("sweep: [{key: association.mode, name: association, values: [own, shared]}]\n"));
  EXPECT_THAT(named("\"a\\nb\""), HasSubstr("sweep.0.name: a line break"));
  EXPECT_THAT(named("''"), HasSubstr("sweep.0.name: a text is empty"));
  EXPECT_THAT(refusal_of_study("sweep: [{key: seed, values: [1, 2], labels: [a, " +
                               std::string(300, 'x') + "]}]\n"),
              HasSubstr("sweep.0.labels: 'xxxxxxxxxxxxxxxxxxxx…' has 300 characters; a table has "
                        "room for 80"));
}

// Where the swept value decides which keys have an effect, one cell that uses a key is enough.
TEST(ConfigureStudy, RefusesAKeyThatNoCellUses) {
  const std::string sweep = "sweep: [{key: dataset.mission.type, values: [single_loop, sweep]}]\n";
  const std::string keys = "dataset: {mission: {loop_length_m: 5, legs: 3}}\n";
  const Study study = study_of(keys + sweep);
  EXPECT_EQ(value_of(study, "dataset.mission.loop_length_m"), "5");
  EXPECT_EQ(value_of(study, "dataset.mission.legs"), "3");
  EXPECT_THAT(refusal_of_study("dataset.mission.waypoints_m: [0, 0, 1, 1]\n" + sweep),
              HasSubstr("config.yaml:1: dataset.mission.waypoints_m: dataset.mission.type "
                        "single_loop has no use for it"));
}

TEST(ConfigureStudy, RefusesWhatIsNoSweep) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"sweep: 3\n", "config.yaml:1: sweep: expected a list of axes"},
      {"sweep: [{values: [1]}]\n", "sweep.0.key is missing"},
      {"sweep: [{key: seed}]\n", "sweep.0.values is missing"},
      {"sweep: [{key: seed, values: 3}]\n", "sweep.0.values: expected a list"},
      {"sweep: [{key: seed, values: []}]\n", "sweep.0.values: expected a list"},
      {"sweep: [{key: seed, values: [1, 2, 1]}]\n", "'1' is given twice"},
      {"sweep: [{key: seed, value: [1]}]\n", "did you mean 'values'?"},
      {"sweep: [{key: seed, values: [1, 2], labels: [a]}]\n", "expected one for each of the 2"},
      {"sweep: [{key: seeed, values: [1]}]\n", "unknown key 'seeed'; did you mean 'seed'?"},
      {"sweep: [{key: seed, values: [x]}]\n", "config.yaml:1: seed: expected a whole number"},
      {"sweep: [{key: trials, values: [1]}]\n", "trials is the study's own"},
      {"sweep: [{key: report.title, values: [1]}]\n", "report.title is the study's own"},
      {"sweep: [{key: seed, values: [1]}, {key: seed, values: [2]}]\n",
       "sweep.1.key: two axes have the key 'seed'"},
      {"sweep: [{key: seed, name: a, values: [1]}, {key: seed, name: b, values: [2]}]\n",
       "sweep.1.key: two axes have the key 'seed'"},
      {"sweep: [{key: seed, name: a, values: [1]}, {key: dataset.frames, name: a, values: [2]}]\n",
       "sweep.1.name: two axes have the name 'a'"},
      {"seed: 4\nsweep: [{key: seed, values: [1]}]\n",
       "config.yaml:1: seed: is swept, so this value would go unread; change sweep.0.values"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.max_iteration, values: [1]}]\n",
       "did you mean 'estimators.0.max_iterations'?"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.1.type, values: [ekf]}]\n",
       "two estimators are called 'ekf'"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.name, values: [a, b]}]\n",
       "names change from cell to cell"},
      {"estimators: [{type: ekf, tolerance: 1}]\n",
       "config.yaml:1: estimators.0.tolerance: ekf has no use for it and would ignore it"},
      {"estimators: [{type: ekf}]\nsweep: [{key: estimators.0.max_iterations, values: [1, 5]}]\n",
       "estimators.0.max_iterations: ekf has no use for it"},
      {"trials: 0\n", "trials: expected a whole number"},
      {"evaluation: {rpe_keyframes: [1.5]}\n", "evaluation.rpe_keyframes: expected whole numbers"},
      {"evaluation: {rpe_distances_m: [0]}\n", "evaluation.rpe_distances_m: expected numbers in m"},
      {"association: {mode: own, reference: ekf}\n",
       "config.yaml:1: association.reference: nobody's estimate but each one's own picks the loop "
       "candidates"},
      {"estimators: [{type: ekf, name: dead_reckoning}]\n", "is the baseline of every table"},
      {"estimators: [{type: ekf, name: __proto__}]\n",
       "estimators.0.name: __proto__ means something to the page of a report"},
      {"estimators: [{type: ekf, name: constructor}]\n", "give another one"},
      {"estimators: [{type: ekf, name: figures}]\n", "figures is a folder of a report"},
      {"estimators: [{type: ekf, name: batch_optimum}]\n", "batch_optimum is a folder of"}};
  for (const auto& [text, message] : cases)
    EXPECT_THAT(refusal_of_study(text), HasSubstr(message)) << text;
}

TEST(ConfigureStudy, RefusesAMetricThatIsNone) {
  EXPECT_THAT(refusal_of_study("report: {metrics: [anees, mean_postion_error_m]}\n"),
              HasSubstr("report.metrics: unknown metric 'mean_postion_error_m'; did you mean "
                        "'mean_position_error_m'?"));
  EXPECT_THAT(refusal_of_study("report: {metrics: [rpe_N_keyframes_m]}\n"),
              HasSubstr("'rpe_N_keyframes_m': expected a number in place of N or D"));
  EXPECT_NO_THROW(study_of("report: {metrics: [rpe_7_keyframes_m, relative_anees_2.5_m]}\n"));
}

TEST(ConfigureStudy, AGraphHasNoNoiseToDraw) {
  const std::string graph = "dataset: {type: g2o, path: a.g2o}\n";
  EXPECT_THAT(refusal_of_study(graph + "trials: 2\n"),
              HasSubstr("trials: a pose graph without false loops"));
  EXPECT_THAT(refusal_of_study(graph + "association: {mode: own}\n"),
              HasSubstr("association.mode: a pose graph has its loops"));
  EXPECT_EQ(study_of(graph).cells.size(), 1u);
}

TEST(ConfigureStudy, ADrawnLogHasTrials) {
  const std::string drawn = "dataset: {type: simulated_log}\n";
  EXPECT_EQ(study_of(drawn + "trials: 2\n").description.trials, 2u);
  EXPECT_THAT(refusal_of_study(drawn + "association: {mode: own}\n"),
              HasSubstr("association.mode: a pose graph has its loops"));
  EXPECT_THAT(refusal_of_study(drawn + "dataset.loops.tail_factor: 5\n"),
              HasSubstr("dataset.loops.tail_factor"));
}

TEST(WithoutSweep, LeavesTheRest) {
  const Settings settings =
      without_sweep(settings_of("seed: 4\nsweep: [{key: trials, values: [1]}]\n"));
  ASSERT_EQ(settings.all().size(), 1u);
  EXPECT_EQ(settings.all().front().key, "seed");
}

}  // namespace
}  // namespace fathom
