// False loops in recordings, their list on disk, and what is counted of them.

#include "fathom/harness/false_loops.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/square_log.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using test::kComparison;
using test::refusal;
using ::testing::HasSubstr;

Recording square_with_ids() {
  Recording recording;
  recording.log = test::square_log();
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    recording.log.ids.push_back(static_cast<std::int64_t>(10 * k));
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * 10'000'000'000);
  }
  return recording;
}

TEST(FalseLoops, AreJudgedByTheTruthOrTheOptimum) {
  Recording recording = square_with_ids();
  const std::vector<Pose> optimum = reference_poses(recording, builtin_estimators());
  EXPECT_LT(chi2(recording.log, optimum), 0.1 * chi2(recording.log, recording.log.odometry()));
  recording.ground_truth = test::square_truth();
  EXPECT_EQ(reference_poses(recording, builtin_estimators()), test::square_truth());
}

TEST(FalseLoops, StandInARecordingByRegistration) {
  Recording recording = square_with_ids();
  spoil_recording(recording, {.share = 0.5}, builtin_estimators(), 1, 0);
  EXPECT_EQ(recording.log.registration_count(), 8u);
  EXPECT_EQ(recording.is_false_loop.size(), 8u);
  EXPECT_EQ(std::count(recording.is_false_loop.begin(), recording.is_false_loop.end(), true), 4);
  Recording other = square_with_ids();
  spoil_recording(other, {.share = 0.5}, builtin_estimators(), 1, 1);
  EXPECT_NE(to_g2o(other.log), to_g2o(recording.log));
}

TEST(FalseLoops, TheListReadsBack) {
  const test::TemporaryFolder folder;
  const Recording recording = square_with_ids();
  const Spoiled spoiled = spoil(recording.log, test::square_truth(), {.share = 0.5}, 3);
  write_file(folder / "g.g2o", to_g2o(spoiled.log));
  write_file(folder / "list.csv", false_loops_csv(spoiled));
  const MeasurementLog log = read_g2o(folder / "g.g2o");
  EXPECT_EQ(read_false_loops(folder / "list.csv", log), spoiled.is_false);
  write_file(folder / "blank.csv", "\n" + false_loops_csv(spoiled));
  EXPECT_EQ(read_false_loops(folder / "blank.csv", log), spoiled.is_false);
  const auto refused = [&](const std::string& text) {
    write_file(folder / "bad.csv", text);
    return input_error_of([&] { read_false_loops(folder / "bad.csv", log); });
  };
  EXPECT_THAT(refused("from,to\n"), HasSubstr(":1: expected the header registration,from,to"));
  EXPECT_THAT(refused("\n0,0,40\n"), HasSubstr(":2: expected the header"));
  EXPECT_THAT(refused("registration,from,to\n99,0,40\n"), HasSubstr(":2: '99,0,40' is no"));
  EXPECT_THAT(refused("registration,from,to\n0,0,41\n"), HasSubstr(":2: '0,0,41' is no"));
}

TEST(FalseLoops, ARunLeavesTheWeightOfEveryRegistration) {
  const test::TemporaryFolder folder;
  Recording recording = square_with_ids();
  // The square of the loop 3-7 is off by 5 m in what a robust loss is told.
  RelativePose wrong = recording.log.arrival(7).registrations[0];
  wrong.motion.x += 5.0;
  recording.log.add_registration(wrong);
  recording.is_false_loop = {false, false, false, false, true};
  const EstimatorConfiguration estimator{"sparse_gauss_newton",
                                         "sparse_gauss_newton",
                                         {{"loss", OptionValue::scalar("geman_mcclure")}}};
  const Result result = evaluate(recording, estimator, builtin_estimators(), {}, {});
  EXPECT_EQ(result.metric("false_loops_kept"), 0.0);
  EXPECT_EQ(result.metric("loops_kept"), 4.0);
  const std::string written = metrics_json(result, recording);
  EXPECT_THAT(written, HasSubstr("\"false_loops\": 1"));
  EXPECT_THAT(written, HasSubstr("\"right_loops_lost\": 0"));
  write_run(folder.path(), recording, result, "{}");
  const std::string csv = read_file(folder / "registrations.csv");
  EXPECT_THAT(csv, HasSubstr("from,to,fate,nis,weight,false\n0,40,used,,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
}

TEST(FalseLoops, AreKeysOfAStudy) {
  const std::string list = "estimators: [{type: ekf}]\n";
  const Configuration study = configured(
      list + "association.false_loops: {share: 0.3, kind: grouped, group_size: 3}\n", kComparison);
  EXPECT_EQ(study.study.false_loops.share, 0.3);
  EXPECT_EQ(study.study.false_loops.kind, FalseLoopKind::grouped);
  EXPECT_EQ(study.study.false_loops.group_size, 3);
  const auto refused = [&](const std::string& text) { return refusal(list + text, kComparison); };
  EXPECT_THAT(
      refused("association.false_loops: {share: 0.3, reach: 9}\n"),
      HasSubstr(
          "association.false_loops.reach: association.false_loops.kind random has no use for it"));
  EXPECT_THAT(
      refused("association.false_loops: {kind: local}\n"),
      HasSubstr("association.false_loops.kind: association.false_loops.share 0 has no use for it"));
  EXPECT_THAT(refused("association.false_loops: {share: 1}\n"), HasSubstr("<= 0.9"));
  EXPECT_THAT(refusal("association.false_loops: {share: 0.3}\n"), HasSubstr("it is for 'compare'"));
  // A graph's trials differ by their false loops.
  EXPECT_THAT(refused("dataset: {type: g2o, path: g.g2o}\ntrials: 2\n"),
              HasSubstr("trials: a pose graph without false loops has nothing to draw"));
  EXPECT_EQ(refused("dataset: {type: g2o, path: g.g2o}\ntrials: 2\n"
                    "association.false_loops: {share: 0.3}\n"),
            "(nothing thrown)");
}

// Options that need one another may stand in any order.
TEST(FalseLoops, ALossAndItsScaleInAnyOrder) {
  EXPECT_NO_THROW(
      configured("estimator: {type: sparse_gauss_newton, loss_scale: 2, loss: geman_mcclure}\n"));
  EXPECT_THAT(refusal("estimator:\n  type: sparse_gauss_newton\n  loss_scale: 2\n"),
              HasSubstr("config.yaml:3: estimator.loss_scale: without a loss"));
}

}  // namespace
}  // namespace fathom
