// Estimators of somebody else's that do what none may: each gets a verdict, and the study goes on.

#include <cerrno>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/guarded_estimator.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/harness/run_record.hpp"
#include "fathom/harness/study_run.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/small_config.hpp"
#include "harness/square_log.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::Script;
using test::scripted;
using test::square_log;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Fault {
  const char* message;
  std::function<void(Script&)> script;
};

// The square log has updates at keyframes 4 (one registration), 5 (two) and 7 (one).
std::vector<Fault> faults() {
  return {
      {"update at keyframe 4: has 0 decisions on registrations, expected 1",
       [](Script& s) { s.spoil_report = [](UpdateReport& r) { r.loops.clear(); }; }},
      {"update at keyframe 5: has 3 decisions on registrations, expected 2",
       [](Script& s) {
         s.spoil_report = [](UpdateReport& r) {
           if (r.loops.size() == 2) r.loops.push_back(r.loops.back());
         };
       }},
      {"update at keyframe 4: decision 0 is on other keyframes than registration 0",
       [](Script& s) { s.spoil_report = [](UpdateReport& r) { r.loops[0].to = 1'000'000; }; }},
      {"create at keyframe 0: size() is 3, expected 1", [](Script& s) { s.size_error = 2; }},
      {"pose at keyframe 7: pose 5 is not finite", [](Script& s) { s.nan_pose = 5; }},
      {"create at keyframe 0 threw an exception: no licence",
       [](Script& s) { s.in_every_call = [] { throw std::runtime_error("no licence"); }; }},
      {"update at keyframe 5 threw what is no std::exception",
       [](Script& s) {
         s.spoil_report = [](UpdateReport& r) {
           if (r.loops.size() == 2) throw 7;
         };
       }},
      {"loop_weights at keyframe 7: has 3 weights, expected 4",
       [](Script& s) {
         s.loop_weights = {1, 1, 1};
       }},
      {"loop_weights at keyframe 7: a weight is not finite",
       [](Script& s) {
         s.loop_weights = {1, 1, 1, kNaN};
       }},
      {"covariance at keyframe 7: that of keyframe 2 is not finite",
       [](Script& s) { s.covariances[2] = Eigen::Matrix3d::Constant(kNaN); }},
      {"loss at keyframe 7 threw an exception: no loss",
       [](Script& s) { s.loss = [](double) -> double { throw std::logic_error("no loss"); }; }},
  };
}

Recording square_recording() {
  Recording recording;
  recording.log = square_log();
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    recording.keyframe_times_ns.push_back(static_cast<std::int64_t>(k) * 1'000'000'000);
  }
  recording.ground_truth = recording.log.odometry();
  return recording;
}

TEST(FaultyEstimator, GetsAVerdictWithTheReason) {
  const MeasurementLog log = square_log();
  for (const auto& [message, spoil] : faults()) {
    Script script;
    spoil(script);
    const auto result = replay(log, scripted(script), {}, {});
    EXPECT_EQ(result.fault, message);
    EXPECT_EQ(result.outcome, Outcome::numerical_failure) << message;
    EXPECT_EQ(result.trajectory.size(), log.size()) << message;
    ASSERT_EQ(result.loops.size(), log.registration_count()) << message;
    for (const LoopDecision& loop : result.loops) EXPECT_NE(loop.fate, LoopFate::used);
    EXPECT_EQ(result.loop_weights.size(), log.registration_count()) << message;
    EXPECT_THAT(result.loop_weights, Each(0.0)) << message;
    EXPECT_FALSE(result.covariances) << message;
  }
}

TEST(FaultyEstimator, MovesOnlyKeyframesThatThereAre) {
  Script script;
  script.moved = {0, 7};
  GuardedEstimator guarded(scripted(script), {}, {});
  EXPECT_FALSE(guarded.moved_since(0).keyframes);
  EXPECT_EQ(guarded.fault(), "moved_since at keyframe 0: names keyframe 7");
}

TEST(FaultyEstimator, IsFoundOutInABatch) {
  Script script;
  script.finish.loops.push_back({0, 4, LoopFate::used, 1.0});
  ReplayOptions options;
  options.mode = SolveMode::batch;
  const auto result = replay(square_log(), scripted(script), {}, options);
  EXPECT_EQ(result.fault, "finish at keyframe 7: has 1 decisions on registrations, expected 0");
  EXPECT_EQ(result.outcome, Outcome::numerical_failure);
}

TEST(FaultyEstimator, AnHonestFailureIsNoFault) {
  Script script;
  script.updates = {{Outcome::diverged, 3, {}}};
  script.without_covariance = 3;
  const auto result = replay(square_log(), scripted(script), {}, {});
  EXPECT_THAT(result.fault, IsEmpty());
  EXPECT_EQ(result.outcome, Outcome::diverged);
}

TEST(FaultyEstimator, IsJudgedAndWrittenDown) {
  const Recording recording = square_recording();
  for (const auto& [message, spoil] : faults()) {
    Script script;
    spoil(script);
    EstimatorRegistry registry;
    registry.add(scripted(script));
    registry.add(builtin_estimators().find("sparse_gauss_newton"));
    const Result result = evaluate(recording, {"mine", "scripted", {}}, registry, {}, {});
    EXPECT_FALSE(result.is_done());
    EXPECT_EQ(result.metric("loop_closures"), 0.0);
    EXPECT_EQ(result.metric("lost"), static_cast<double>(recording.log.registration_count()));
    EXPECT_THAT(metrics_json(result, recording), HasSubstr(message));
    const RunRecord run = run_record(recording, result, "");
    EXPECT_EQ(run.outcome, "numerical_failure");
    EXPECT_EQ(run.fault, message);
    for (const auto& [name, value] : run.metrics) EXPECT_TRUE(std::isfinite(value)) << name;
    const test::TemporaryFolder folder;
    write_run(folder.path(), recording, result, "{}");
  }
}

// Nor is it stored: the same study, once the disk has room, has the run.
TEST(FaultyEstimator, AFaultOfTheEnvironmentIsNobodysResult) {
  for (const std::string isolation : {"none", "process"}) {
    bool is_full = true;
    Script script;
    script.spoil_report = [&](UpdateReport&) {
      if (is_full) throw EnvironmentError("/tmp/x", "cannot be written", ENOSPC);
    };
    EstimatorRegistry registry;
    registry.add(scripted(script));
    registry.add(builtin_estimators().find("ekf"));
    const Study study = configure_study(
        test::settings_of("dataset:\n  type: simulated_log\n  mission: {type: single_loop, "
                          "loop_length_m: 20, loop_width_m: 2}\nestimators: [{type: scripted}, "
                          "{type: ekf}]\nisolation: " +
                          isolation + "\n"),
        registry);
    const test::TemporaryFolder folder;
    ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
    EXPECT_EQ(test::input_error_of([&] { run_study(study, registry, store, {}); }),
              "/tmp/x: cannot be written: No space left on device");
    for (const RunRecord& run : store.runs()) EXPECT_NE(run.key.estimator, "scripted");
    is_full = false;
    EXPECT_TRUE(run_study(study, registry, store, {}).is_finished);
    for (const RunRecord& run : store.runs()) EXPECT_THAT(run.fault, IsEmpty());
    EXPECT_EQ(store.runs().size(), 3u);
  }
}

// The reference of `association.mode: own` runs along with the front end, too.
TEST(FaultyEstimator, LetsTheStudyGoOn) {
  for (const char* const association : {"mode: own", "reference: scripted"}) {
    Script script;
    script.spoil_report = [](UpdateReport& report) { report.loops.clear(); };
    EstimatorRegistry registry;
    registry.add(scripted(script));
    registry.add(builtin_estimators().find("ekf"));
    const Study study =
        configure_study(test::settings_of(std::string(test::kSmallSurvey) +
                                          "estimators: [{type: scripted}, {type: ekf}]\n"
                                          "association: {" +
                                          association + "}\n"),
                        registry);
    const test::TemporaryFolder folder;
    ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
    EXPECT_TRUE(run_study(study, registry, store, {}).is_finished);
    store.finish();
    const ResultStore stored = ResultStore::open(folder.path());
    const std::vector<RunRecord> runs = stored.runs();
    ASSERT_EQ(runs.size(), 3u);
    EXPECT_EQ(runs[1].outcome, "numerical_failure");
    EXPECT_THAT(runs[1].fault, HasSubstr("has 0 decisions on registrations"));
    EXPECT_EQ(runs[2].outcome, "converged");
    EXPECT_THAT(runs[2].fault, IsEmpty());
    EXPECT_GT(runs[2].metrics.at("loop_closures"), 0.0);
  }
}

}  // namespace
}  // namespace fathom
