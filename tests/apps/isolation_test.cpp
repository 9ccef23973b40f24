// Runs in processes of their own, through the real command line.

#include <csignal>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "apps/processes.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Isolation : public CommandLine {
 protected:
  /// A run of the misbehaving estimator; its metrics.json.
  nlohmann::json run(const std::string& fault, const Arguments& more = {}) {
    write("log.yaml", kLog);
    Arguments arguments{"run",
                        "log.yaml",
                        "--out",
                        fault,
                        "--quiet",
                        "--plugin",
                        plugin("misbehaving"),
                        "--set",
                        "estimator.type=misbehaving",
                        "--set",
                        "estimator.fault=" + fault};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ended_ = fathom(arguments);
    return json_of(fault + "/metrics.json");
  }

  Ended ended_;
};

TEST_F(Isolation, ACrashIsAnOutcomeWithItsSignalAndLastLines) {
  const nlohmann::json metrics = run("crash");
  EXPECT_EQ(ended_.status, 1);
  EXPECT_EQ(metrics.at("outcome"), "crashed");
  EXPECT_EQ(metrics.at("fault"),
            "was ended by signal 11 (Segmentation fault); it printed last: first line | about to "
            "crash ?");
  EXPECT_FALSE(metrics.contains("mean_position_error_m"));
}

TEST_F(Isolation, AHangIsEndedAtItsTime) {
  const nlohmann::json metrics = run("hang", {"--set", "time_limit_s=0.3"});
  EXPECT_EQ(metrics.at("outcome"), "timed_out");
  EXPECT_EQ(metrics.at("fault"), "was killed after 0.3 s");
}

TEST_F(Isolation, WhatItPrintedIsOnTheTerminal) {
  write("log.yaml", kLog);
  write("s.yaml", std::string(kLog) +
                      "trials: 2\nestimators:\n  - {type: ekf}\n  - {type: "
                      "misbehaving, fault: crash}\n");
  const Arguments plug_in{"--plugin", plugin("misbehaving")};
  for (Arguments arguments : {Arguments{"run", "log.yaml", "--set", "estimator.type=misbehaving",
                                        "--set", "estimator.fault=crash"},
                              Arguments{"compare", "s.yaml"}}) {
    arguments.insert(arguments.end(), plug_in.begin(), plug_in.end());
    const Ended ended = fathom(arguments);
    EXPECT_THAT(ended.out + ended.err,
                HasSubstr("misbehaving: was ended by signal 11 (Segmentation fault); it printed "
                          "last: first line"));
  }
}

// The example of a study that is there already is shown again, and ends as it did.
TEST_F(Isolation, AStudyThatHungIsShownAgain) {
  write("s.yaml", std::string(kLog) + "time_limit_s: 0.2\nplugins: [" + plugin("misbehaving") +
                      "]\nestimators:\n  - {type: ekf}\n  - {type: misbehaving, fault: hang}\n");
  const Ended first = fathom({"compare", "s.yaml", "--out", "study"});
  EXPECT_EQ(first.status, 1);
  const Ended again = fathom({"compare", "s.yaml", "--out", "study"});
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, HasSubstr("0/1 done, 1 timed out"));
  const nlohmann::json metrics = json_of("study/metrics.json");
  EXPECT_EQ(metrics.at(1).at("outcome"), "timed_out");
  EXPECT_EQ(metrics.at(1).at("fault"), "was killed after 0.2 s");
}

// What is drawn is the first cell, where it does nothing wrong.
TEST_F(Isolation, AFaultInAnotherRunThanTheOneThatIsDrawnIsSaid) {
  write("s.yaml", std::string(kLog) + "plugins: [" + plugin("misbehaving") +
                      "]\nestimators:\n  - {type: misbehaving}\n"
                      "sweep: [{key: estimators.0.fault, name: kind, values: [none, exit]}]\n");
  const Ended ended = fathom({"compare", "s.yaml", "--out", "study"});
  EXPECT_THAT(ended.out + ended.err, HasSubstr("misbehaving: 1 run ended by a fault, the first: "));
}

TEST_F(Isolation, MemoryWithoutEndIsEndedAtItsLimit) {
  if (!FATHOM_MEASURES_MEMORY) GTEST_SKIP() << "not with a sanitizer";
  for (const char* const fault : {"memory", "c_memory"}) {
    const nlohmann::json metrics = run(fault, {"--set", "memory_limit_mib=100"});
    EXPECT_EQ(metrics.at("outcome"), "out_of_memory") << fault;
    EXPECT_EQ(metrics.at("fault"), "found no memory within 100 MiB") << fault;
  }
}

// What the system allows says nothing of the estimator.
TEST_F(Isolation, ALimitOfTheSystemIsNoResult) {
  if (!FATHOM_MEASURES_MEMORY) GTEST_SKIP() << "not with a sanitizer";
  surroundings_.address_space_bytes = std::size_t{3} << 30;
  write("log.yaml", kLog);
  EXPECT_THAT(
      refusal({"run", "log.yaml", "--out", "out", "--plugin", plugin("misbehaving"), "--set",
               "estimator.type=misbehaving", "--set", "estimator.fault=memory"}),
      HasSubstr("memory_limit_mib: a run found no memory, as 'ulimit -v' gives this program "
                "3072 MiB, and the run may have 4096 MiB"));
}

TEST_F(Isolation, AnExitAndADeathInTheDestructorAreCrashes) {
  EXPECT_EQ(run("exit").at("fault"), "ended its process itself, with status 3");
  EXPECT_THAT(run("destructor").at("fault").get<std::string>(), HasSubstr("signal 6"));
}

TEST_F(Isolation, WhatItPrintsGoesNowhere) {
  const nlohmann::json metrics = run("noise");
  EXPECT_EQ(metrics.at("outcome"), "converged");
  EXPECT_EQ(ended_.out, "");
  EXPECT_EQ(ended_.err, "");
}

TEST_F(Isolation, NoProcessIsLeftOfOneThatForks) {
  EXPECT_EQ(run("fork").at("outcome"), "converged");
  EXPECT_TRUE(none_is_left("7654.03125"));
}

TEST_F(Isolation, LimitsWithoutProcessesAreRefused) {
  write("c.yaml", std::string(kLog) + "time_limit_s: 3\nestimator: {type: ekf}\n");
  EXPECT_THAT(refusal({"run", "c.yaml"}),
              HasSubstr("c.yaml:5: time_limit_s: no estimator runs in"));
}

TEST_F(Isolation, OneThatSelectsCandidatesOfAStudyIsRefused) {
  write("s.yaml",
        "dataset: {type: simulated}\nassociation: {mode: own}\nisolation: process\n"
        "estimators: [{type: ekf}]\n");
  EXPECT_THAT(refusal({"compare", "s.yaml"}), HasSubstr("would run beside the front end"));
}

constexpr const char* kFour = R"(  - {type: ekf}
  - {type: trajectory_iekf}
  - {type: sparse_gauss_newton}
)";

// What is stored of the others' runs, cost left out.
std::map<std::string, std::map<std::string, double>> others(const fs::path& study) {
  std::map<std::string, std::map<std::string, double>> rows;
  for (const RunRecord& run : ResultStore::open(study).runs()) {
    if (run.key.estimator == "misbehaving") continue;
    auto metrics = run.metrics;
    std::erase_if(metrics, [](const auto& one) { return is_cost_metric(one.first); });
    rows[run.key.estimator + "/" + std::to_string(run.key.trial)] = metrics;
  }
  return rows;
}

TEST_F(Isolation, AStudyOf200RunsSurvivesIt) {
  const std::string limits = "trials: 50\ntime_limit_s: 1\nmemory_limit_mib: 64\n";
  write("mixed_with_faults.yaml", std::string(kLog) + limits + "plugins: [" +
                                      plugin("misbehaving") + "]\nestimators:\n" + kFour +
                                      "  - {type: misbehaving, fault: random}\n");
  write("without.yaml", std::string(kLog) + "trials: 50\nestimators:\n" + kFour);
  fathom_done({"compare", "without.yaml", "--out", "without"});
  // Killed in the middle, it goes on.
  const Ended killed =
      fathom({"compare", "mixed_with_faults.yaml", "--out", "with", "--jobs", "2"}, [&](pid_t id) {
        std::error_code none;
        if (fs::file_size(path("with/results.sqlite"), none) > 100'000 && !none)
          ::kill(id, SIGKILL);
      });
  EXPECT_EQ(killed.status, 128 + SIGKILL);
  fathom({"compare", "mixed_with_faults.yaml", "--out", "with", "--jobs", "2"});
  std::map<std::string, int> outcomes;
  for (const RunRecord& run : ResultStore::open(path("with")).runs()) {
    if (run.key.estimator == "misbehaving") ++outcomes[run.outcome];
  }
  EXPECT_EQ(others(path("with")), others(path("without")));
  EXPECT_EQ(outcomes.size(), FATHOM_MEASURES_MEMORY ? 4u : 3u);
  EXPECT_GT(outcomes["converged"], 0);
  EXPECT_GT(outcomes["crashed"], 0);
  EXPECT_GT(outcomes["timed_out"], 0);
  EXPECT_TRUE(none_is_left("mixed_with_faults.yaml"));
  EXPECT_EQ(fathom_done({"report", "with"}).err, "");
}

}  // namespace
}  // namespace fathom::test
