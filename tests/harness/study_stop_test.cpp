// A study that is stopped in the middle of a trial: nothing half done is stored, and it goes on.

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/program.hpp"
#include "fathom/core/system.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/study_run.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/small_config.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::Script;
using test::scripted;
using ::testing::IsEmpty;
using ::testing::SizeIs;

EstimatorRegistry registry_of(Script& script) {
  EstimatorRegistry registry;
  registry.add(builtin_estimators().find("ekf"));
  registry.add(scripted(script));
  return registry;
}

Study study_of(const EstimatorRegistry& registry, const std::string& text) {
  return configure_study(test::settings_of(text), registry);
}

constexpr const char* kLog = R"(
dataset:
  type: simulated_log
  mission: {type: single_loop, loop_length_m: 20, loop_width_m: 2}
estimators: [{type: ekf}, {type: scripted}]
)";

// Whether the estimator that was made last is to estimate, not to find the optimum of the batch.
bool is_estimating(const Script& script) {
  const auto made =
      std::find_if(script.calls.rbegin(), script.calls.rend(),
                   [](const std::string& call) { return call.starts_with("create"); });
  return made != script.calls.rend() && *made == "create";
}

TEST(StudyStop, LeavesAReplayAtItsNextKeyframe) {
  Script script;
  std::atomic<bool> stop = false;
  std::size_t added = 0;
  script.in_every_call = [&] {
    if (script.calls.empty() || !script.calls.back().starts_with("add ")) return;
    if (is_estimating(script) && ++added == 3) stop = true;
  };
  const EstimatorRegistry registry = registry_of(script);
  const Study study = study_of(registry, kLog);
  const test::TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
  StudyRunOptions options;
  options.stop = &stop;
  const StudyRun stopped = run_study(study, registry, store, options);
  EXPECT_FALSE(stopped.is_finished);
  EXPECT_THAT(stopped.example, IsEmpty());
  EXPECT_EQ(added, 3u);
  EXPECT_THAT(store.runs(), SizeIs(2));  // dead reckoning and the filter

  stop = false;
  EXPECT_TRUE(run_study(study, registry, store, options).is_finished);
  EXPECT_GT(added, 10u);
  EXPECT_THAT(store.runs(), SizeIs(3));
}

// A signal to all processes of a job ends the program of an estimator, too.
TEST(StudyStop, ARunThatIsLostByItIsNotStored) {
  Script script;
  std::atomic<bool> stop = false;
  script.spoil_report = [&](UpdateReport&) {
    if (!is_estimating(script)) return;
    stop = true;
    throw ProgramFailure("'solver' ended: signal 15 (Terminated)");
  };
  const EstimatorRegistry registry = registry_of(script);
  const Study study = study_of(registry, kLog);
  const test::TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
  StudyRunOptions options;
  options.stop = &stop;
  EXPECT_FALSE(run_study(study, registry, store, options).is_finished);
  EXPECT_THAT(store.runs(), SizeIs(2));  // dead reckoning and the filter
}

// One of two trials meets a fault; the other would take a minute.
TEST(StudyStop, ComesSoonWhereOneThreadCannotGoOn) {
  const test::TemporaryFolder folder;
  Script script;
  const long here = process_number();
  script.spoil_report = [&, here](UpdateReport&) {
    if (process_number() == here) return;  // the batch optimum, which runs in no other process
    // Of two processes one is the first; it fails once the other is at work.
    if (!std::filesystem::create_directory(folder / "first")) {
      std::filesystem::create_directory(folder / "second");
      std::this_thread::sleep_for(std::chrono::minutes(1));
    }
    while (!std::filesystem::exists(folder / "second")) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    throw EnvironmentError("/tmp/x", "cannot be written", ENOSPC);
  };
  const EstimatorRegistry registry = registry_of(script);
  const Study study =
      study_of(registry, std::string(kLog) + "trials: 2\njobs: 2\nisolation: process\n");
  ResultStore store = ResultStore::write(folder / "study", study.description, "{}");
  StudyRunOptions options;
  options.jobs = 2;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THROW(run_study(study, registry, store, options), EnvironmentError);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST(StudyStop, LeavesTheFrontEndAtItsNextKeyframe) {
  Script script;
  std::atomic<bool> stop = true;
  const EstimatorRegistry registry = registry_of(script);
  const Study study = study_of(
      registry, std::string(test::kSmallSurvey) + "estimators: [{type: ekf}, {type: scripted}]\n");
  script.calls.clear();
  const test::TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), study.description, "{}");
  StudyRunOptions options;
  options.stop = &stop;
  EXPECT_FALSE(register_pictures(study, registry, options));
  EXPECT_FALSE(run_study(study, registry, store, options).is_finished);
  EXPECT_THAT(store.runs(), IsEmpty());
  EXPECT_THAT(script.calls, IsEmpty());
}

}  // namespace
}  // namespace fathom
