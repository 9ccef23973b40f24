// Surveys with a compass, fixes and holes: from the simulation or from disk the same log, and every
// estimator runs it.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/survey.hpp"
#include "harness/recorded.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/small_config.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using test::kSmallSurvey;
using test::recorded;

constexpr const char* kSensors = R"(
dataset.compass: {interval_s: 0.7, sigma_rad: 0.02}
dataset.fixes: {interval_s: 3.1, covariance: [0.04, 0.01, 0.02], lever_x_m: 0.5, lever_y_m: -0.2}
)";

void expect_same(const AbsolutePose& a, const AbsolutePose& b) {
  EXPECT_EQ(a.keyframe, b.keyframe);
  EXPECT_LT(test::distance(a.pose, b.pose), 1e-9);
  EXPECT_LT((a.information - b.information).norm(), 1e-9 * a.information.norm());
}

void expect_same(const MeasurementLog& a, const MeasurementLog& b) {
  EXPECT_LT(test::distance(a.start().pose, b.start().pose), 1e-9);
  EXPECT_LT((a.start().covariance - b.start().covariance).norm(),
            1e-9 * a.start().covariance.norm() + 1e-300);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.hole_count(), b.hole_count());
  for (std::size_t k = 0; k < a.size(); ++k) {
    const KeyframeMeasurements& of_a = a.arrival(k);
    const KeyframeMeasurements& of_b = b.arrival(k);
    EXPECT_EQ(of_a.step.is_hole, of_b.step.is_hole) << k;
    ASSERT_EQ(of_a.absolute.size(), of_b.absolute.size()) << k;
    for (std::size_t j = 0; j < of_a.absolute.size(); ++j) {
      expect_same(of_a.absolute[j], of_b.absolute[j]);
    }
    if (k == 0) continue;
    EXPECT_LT(test::distance(of_a.step.motion, of_b.step.motion), 1e-9) << k;
    EXPECT_LT((of_a.step.covariance() - of_b.step.covariance()).norm(),
              1e-9 * of_a.step.covariance().norm());
    EXPECT_EQ(of_a.registrations.size(), of_b.registrations.size()) << k;
  }
}

void expect_same_from_disk(const std::string& more, const std::string& of_folder) {
  const Configuration simulation = configured(kSmallSurvey + more);
  const Recording direct = recorded(simulation);
  const test::TemporaryFolder folder;
  const Survey survey(simulation);
  write_image_folder(survey.frames(), folder.path(), survey.readings());
  const Configuration from_disk = configured(
      "dataset: {type: image_folder, path: " + folder.path().string() + "}\n" + of_folder +
      std::string(kSmallSurvey).substr(std::string(kSmallSurvey).find("front_end:")));
  const Recording read = recorded(from_disk);
  expect_same(direct.log, read.log);
}

TEST(AbsoluteRecording, ASimulationOnDiskGivesTheSameLog) {
  expect_same_from_disk(kSensors,
                        "dataset.compass.interval_s: 0.7\ndataset.fixes.interval_s: 3.1\n");
}

TEST(AbsoluteRecording, ASimulationWithHolesOnDiskGivesTheSameLog) {
  expect_same_from_disk(std::string(kSensors) +
                            "dataset.holes: {count: 2, length_s: 1.5}\n"
                            "dataset.speed_limit_m_s: 0.8\n",
                        "dataset.compass.interval_s: 0.7\ndataset.fixes.interval_s: 3.1\n"
                        "dataset.gap_intervals: 1.5\ndataset.speed_limit_m_s: 0.8\n");
}

TEST(AbsoluteRecording, ReadingsChangeNothingElseOfALog) {
  const Recording without = recorded(configured(kSmallSurvey));
  EXPECT_TRUE(without.log.start().is_fixed());
  EXPECT_EQ(without.log.absolute_count(), 0u);
  const Recording with = recorded(configured(std::string(kSmallSurvey) + kSensors));
  EXPECT_GT(with.log.absolute_count(), 20u);
  ASSERT_EQ(with.log.size(), without.log.size());
  for (std::size_t k = 1; k < with.log.size(); ++k) {
    EXPECT_EQ(with.log.arrival(k).step.motion, without.log.arrival(k).step.motion);
  }
}

// So that candidates are searched where compass and fixes have the newest keyframe. The log has
// both in one arrival.
TEST(AbsoluteRecording, AKeyframesOwnReadingsComeBeforeItsCandidates) {
  const Configuration configuration =
      configured(std::string(kSmallSurvey) + kSensors + test::kStatedSigmas);
  test::Script script;
  EstimatorRegistry registry;
  registry.add(test::scripted(script));
  const CandidateReference reference{
      CandidateReference::Kind::estimate, {"scripted", "scripted", {}}, true};
  const Recording recording =
      Recorder(configuration).record(configuration, reference, registry, {1, 0});
  std::vector<std::string> expected{"create"};
  const auto expect_update = [&](const std::string& measurements) {
    if (!measurements.empty()) expected.push_back("close" + measurements);
  };
  std::size_t both = 0;
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    const auto& [step, registrations, absolute] = recording.log.arrival(k);
    if (k > 0) expected.push_back("add " + std::to_string(k));
    std::string at;
    for (std::size_t j = 0; j < absolute.size(); ++j) at += " at " + std::to_string(k);
    std::string loops;
    for (const RelativePose& z : registrations) {
      loops += " " + std::to_string(z.from) + "-" + std::to_string(z.to);
    }
    expect_update(at);
    expect_update(loops);
    if (!at.empty() && !loops.empty()) ++both;
  }
  EXPECT_EQ(script.calls, expected);
  EXPECT_GT(both, 5u);
}

// In the world of the readings, from a start that nobody gave.
TEST(AbsoluteRecording, EveryEstimatorTakesThem) {
  const Recording recording = recorded(configured(std::string(kSmallSurvey) + kSensors));
  EXPECT_FALSE(recording.log.start().is_fixed());
  MetricOptions metrics;
  metrics.alignment = Alignment::none;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const Result result = evaluate(recording, {entry.name, entry.name, {}}, builtin_estimators(),
                                   {.metrics = metrics}, {});
    EXPECT_TRUE(result.is_done()) << entry.name;
    ASSERT_TRUE(result.metric("mean_position_error_m")) << entry.name;
    EXPECT_LT(*result.metric("mean_position_error_m"), 0.2) << entry.name;
  }
}

TEST(AbsoluteRecording, VisualOdometryCarriesThemToo) {
  const Recording recording =
      recorded(configured(std::string(kSmallSurvey) + kSensors + test::kVisualOdometry));
  EXPECT_TRUE(recording.visual_odometry);
  EXPECT_GT(recording.log.absolute_count(), 20u);
  EXPECT_EQ(recording.log.hole_count(), 0u);
}

TEST(AbsoluteRecording, AStartIsWhereItIsSaidToBe) {
  const Recording recording = recorded(
      configured(std::string(kSmallSurvey) + "dataset.start: {x_m: 3, y_m: -2, heading_rad: 1}\n"));
  EXPECT_TRUE(recording.log.start().is_fixed());
  EXPECT_EQ(recording.log.origin(), (Pose{3, -2, 1}));
  EXPECT_EQ(recording.frame_dead_reckoning.front(), (Pose{3, -2, 1}));
}

TEST(AbsoluteRecording, ByOverlapTheFramesAroundAHoleAreKeyframes) {
  Settings settings =
      test::settings_of(std::string(kSmallSurvey) + "dataset.holes: {count: 1, length_s: 2}\n");
  settings.put(parse_override("front_end.keyframes.separation_frames=off"));
  settings.put(parse_override("front_end.keyframes.min_overlap=0.5"));
  const Configuration configuration = configure(settings, test::kSingle, builtin_estimators());
  const Recording recording = recorded(configuration);
  const Survey survey(configuration);
  for (std::size_t i = 1; i < survey.frames().size(); ++i) {
    if (!survey.frames().info(i).is_hole) continue;
    EXPECT_THAT(recording.keyframe_times_ns,
                ::testing::IsSupersetOf(
                    {survey.frames().info(i - 1).time_ns, survey.frames().info(i).time_ns}));
  }
  EXPECT_EQ(recording.log.hole_count(), 4u);
}

TEST(AbsoluteRecording, FixesWithoutAHeadingAreRefusedByTheirKey) {
  EXPECT_EQ(input_error_of([] {
              recorded(configured(std::string(kSmallSurvey) + "dataset.fixes.interval_s: 2\n"));
            }).find("dataset.start.heading_rad: is missing: fixes alone"),
            0u);
}

}  // namespace
}  // namespace fathom
