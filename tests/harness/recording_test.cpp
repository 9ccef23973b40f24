// The way of the data as a whole: survey, front end, log, replay.

#include "fathom/harness/recording.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "harness/recorded.hpp"
#include "harness/small_config.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using test::kSmallSurvey;
using test::kVisualOdometry;
using test::recorded;
using ::testing::AllOf;
using ::testing::HasSubstr;

Configuration small_survey(const std::string& more = "") {
  return configured(kSmallSurvey + more);
}

Result evaluated(const Recording& recording, const EstimatorEntry& entry) {
  return evaluate(recording, {entry.name, entry.name, {}}, builtin_estimators(), {}, {});
}

TEST(Record, SaysHowFarItHasCome) {
  const Configuration configuration = small_survey();
  const Recorder recorder(configuration);
  const auto progress_of_a_pass = [&] {
    std::vector<FrontEndProgress> said;
    const Recording recording =
        recorder.record(configuration, configuration.reference, builtin_estimators(), {5, 0},
                        [&](const FrontEndProgress& at) { said.push_back(at); });
    EXPECT_EQ(said.back().pairs, recording.registrations_tried);
    return said;
  };
  const std::vector<FrontEndProgress> said = progress_of_a_pass();
  EXPECT_EQ(said.front().pictures, 0u);
  EXPECT_TRUE(said.back().is_done());
  ASSERT_TRUE(said.back().of_pairs && said.front().of_pairs);
  EXPECT_EQ(*said.back().of_pairs, said.back().pairs);
  // Dead reckoning promised about as many.
  EXPECT_NEAR(static_cast<double>(*said.front().of_pairs), static_cast<double>(said.back().pairs),
              0.25 * static_cast<double>(said.back().pairs));
  for (std::size_t i = 1; i < said.size(); ++i) {
    EXPECT_EQ(said[i].of_pictures, 33u);
    EXPECT_GE(said[i].pictures, said[i - 1].pictures);
    EXPECT_GE(said[i].pairs, said[i - 1].pairs);
  }
  EXPECT_EQ(said.back().left_s, 0.0);
  EXPECT_EQ(said.back().anew, 1.0);
  // All is known the second time.
  EXPECT_EQ(progress_of_a_pass().back().anew, 0.0);
}

TEST(Record, SaysHowFarItHasComeWithVisualOdometryToo) {
  const Configuration configuration = small_survey(kVisualOdometry);
  std::vector<FrontEndProgress> said;
  record(configuration, builtin_estimators(),
         [&](const FrontEndProgress& at) { said.push_back(at); });
  EXPECT_FALSE(said.front().of_pairs);
  EXPECT_TRUE(said.back().is_done());
  EXPECT_TRUE(said[said.size() / 2].left_s);
}

TEST(Record, MakesALogOfASurvey) {
  const Recording recording = record(small_survey(), builtin_estimators());
  EXPECT_EQ(recording.frames.size(), 33u);
  EXPECT_EQ(recording.frame_dead_reckoning.size(), 33u);
  EXPECT_EQ(recording.log.size(), 11u);
  EXPECT_EQ(recording.keyframe_times_ns.size(), 11u);
  ASSERT_TRUE(recording.ground_truth);
  EXPECT_EQ(recording.ground_truth->size(), 11u);
  EXPECT_GE(recording.registrations_tried, recording.log.registration_count());
  EXPECT_FALSE(recording.visual_odometry);
  // More than the neighbours: the end of the loop sees its beginning.
  EXPECT_GT(recording.log.registration_count(), 12u);
}

TEST(Record, RegistrationsAreTrue) {
  for (const char* odometry : {"", kVisualOdometry}) {
    const Recording recording = recorded(small_survey(odometry));
    const std::vector<Pose>& truth = *recording.ground_truth;
    for (const RelativePose& z : recording.log.edges()) {
      if (z.to == z.from + 1) continue;
      EXPECT_LT(test::distance(z.motion, between(truth[z.from], truth[z.to])), 0.05)
          << z.from << " -> " << z.to;
    }
  }
}

TEST(Record, TheSameSeedMakesTheSameLogAndAnotherOneAnother) {
  const std::string log = to_g2o(recorded(small_survey()).log);
  EXPECT_EQ(to_g2o(recorded(small_survey()).log), log);
  EXPECT_NE(to_g2o(recorded(small_survey("seed: 2\n")).log), log);
}

TEST(Record, TheReferencePicksTheCandidatesAndNothingElse) {
  const auto with_reference = [](const std::string& name) {
    const std::string text = std::string(kSmallSurvey) +
                             "estimators: [{type: trajectory_iekf}, {type: ceres_pose_graph}]\n"
                             "association: {reference: " +
                             name + "}\n";
    return recorded(configured(text, test::kComparison));
  };
  const Recording by_filter = with_reference("trajectory_iekf");
  const Recording by_graph = with_reference("ceres_pose_graph");
  // Both are good enough to pick the same pairs, and a pair registers the same for both.
  EXPECT_EQ(to_g2o(by_filter.log), to_g2o(by_graph.log));
}

TEST(Record, EstimatorsOnTheWrittenLogGiveTheSameToTheLastBit) {
  const Recording recording = recorded(small_survey());
  const test::TemporaryFolder folder;
  write_graph(folder / "log.g2o", recording.log);
  const Recording read = record_graph(folder / "log.g2o");
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const Result direct = evaluated(recording, entry);
    const Result again = evaluated(read, entry);
    EXPECT_EQ(direct.run.trajectory, again.run.trajectory) << entry.name;
    EXPECT_EQ(*direct.run.covariances, *again.run.covariances) << entry.name;
    EXPECT_EQ(direct.metric("chi2"), again.metric("chi2")) << entry.name;
    EXPECT_LT(direct.accuracy->mean_position_error_m, 0.02) << entry.name;
  }
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_of(const MeasurementLog& log) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const RelativePose& z : log.edges()) pairs.emplace_back(z.from, z.to);
  return pairs;
}

// The survey written to disk and read back: the same front end must see the same.
void expect_same_from_disk(const std::string& more) {
  const Configuration simulation = small_survey(more);
  const Recording direct = recorded(simulation);
  const test::TemporaryFolder folder;
  write_image_folder(Survey(simulation).frames(), folder.path());
  Configuration from_disk = simulation;
  from_disk.dataset = {"image_folder", {{"path", OptionValue::scalar(folder.path().string())}}};
  const Recording read = recorded(from_disk);
  EXPECT_EQ(read.keyframe_times_ns, direct.keyframe_times_ns);
  EXPECT_EQ(pairs_of(read.log), pairs_of(direct.log));
  EXPECT_EQ(read.registrations_tried, direct.registrations_tried);
  EXPECT_FALSE(read.visual_odometry);
  const EstimatorEntry& entry = builtin_estimators().find("trajectory_iekf");
  const std::vector<Pose> estimate = evaluated(direct, entry).run.trajectory;
  const std::vector<Pose> again = evaluated(read, entry).run.trajectory;
  ASSERT_EQ(estimate.size(), again.size());
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    EXPECT_LT(test::distance(estimate[k], again[k]), 1e-9) << k;
    EXPECT_LT(test::distance((*direct.ground_truth)[k], (*read.ground_truth)[k]), 1e-12) << k;
  }
}

TEST(Record, ASimulationOnDiskGivesTheSame) {
  expect_same_from_disk("");
}

TEST(Record, ASimulationOnDiskGivesTheSameWithVisualOdometry) {
  // On disk its motions are a sensor's, which share nothing.
  expect_same_from_disk(std::string(kVisualOdometry) + test::kNothingShared);
}

TEST(Record, AFolderWithoutTruthOrOdometryRunsTheSame) {
  const Configuration simulation = small_survey();
  const test::TemporaryFolder folder;
  write_image_folder(Survey(simulation).frames(), folder.path());
  std::filesystem::remove_all(folder.path() / "mav0" / "state_groundtruth_estimate0");
  std::filesystem::remove_all(folder.path() / "mav0" / "odometry0");
  Configuration from_disk = simulation;
  from_disk.dataset = {"image_folder", {{"path", OptionValue::scalar(folder.path().string())}}};
  const Recording recording = recorded(from_disk);
  EXPECT_FALSE(recording.ground_truth);
  EXPECT_TRUE(recording.frame_ground_truth.empty());
  EXPECT_TRUE(recording.visual_odometry);
  EXPECT_EQ(recording.visual_odometry_failures, 0u);
  const Result result = evaluated(recording, builtin_estimators().find("ekf"));
  EXPECT_TRUE(result.is_done());
  EXPECT_FALSE(result.accuracy);
  EXPECT_FALSE(result.consistency);
}

TEST(Record, AGraphHasItsIdsForSeconds) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.g2o") << "EDGE_SE2 3 7 1 0 0 1 0 0 1 0 1\n";
  const Recording recording = record_graph(folder / "a.g2o");
  EXPECT_THAT(recording.keyframe_times_ns, ::testing::ElementsAre(3'000'000'000, 7'000'000'000));
  EXPECT_TRUE(recording.frames.empty());
  const Configuration configuration =
      configured("dataset: {type: g2o, path: '" + (folder / "a.g2o").string() + "'}\n");
  EXPECT_EQ(recorded(configuration).log.size(), 2u);
}

TEST(Record, AGraphOfLargeIdsHasItsPlacesForSeconds) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "a.g2o") << "EDGE_SE2 3 9000000001 1 0 0 1 0 0 1 0 1\n";
  const Recording recording = record_graph(folder / "a.g2o");
  EXPECT_THAT(recording.keyframe_times_ns, ::testing::ElementsAre(0, 1'000'000'000));
  EXPECT_THAT(recording.log.ids, ::testing::ElementsAre(3, 9'000'000'001));
}

TEST(Record, RefusesWhatItCannotOpen) {
  const auto refused = [](const std::string& text) {
    return input_error_of([&] { recorded(configured(text)); });
  };
  EXPECT_THAT(refused("dataset: {type: g2o}\n"), HasSubstr("dataset.path: say where"));
  EXPECT_THAT(refused("dataset: {type: image_folder}\n"), HasSubstr("dataset.path: say where"));
  EXPECT_THAT(refused("dataset: {type: g2o, path: /none/a.g2o}\n"), HasSubstr("/none/a.g2o"));
  EXPECT_THAT(refused("dataset: {type: image_folder, path: /none}\n"), HasSubstr("/none"));
  EXPECT_THAT(refused("dataset: {odometry: {covariance: [0, 0, 0, 0, 0, 0]}}\n"),
              HasSubstr("dataset.odometry.covariance"));
}

TEST(Record, RefusesASingleKeyframe) {
  std::string text = kSmallSurvey;
  const std::string given = "separation_frames: 3";
  text.replace(text.find(given), given.size(), "separation_frames: 33");
  EXPECT_THAT(input_error_of([&] { recorded(configured(text)); }),
              AllOf(HasSubstr("config.yaml:"),
                    HasSubstr(": front_end.keyframes.separation_frames: 33 leads beyond the last "
                              "of 33 frames, so there is a single keyframe; expected at most 32")));
}

}  // namespace
}  // namespace fathom
