// Whatever fails, the program ends, with one line and another status than 0.

#include <csignal>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::StartsWith;

class Failures : public CommandLine {
 protected:
  static void expect_one_line(const Ended& ended) {
    EXPECT_THAT(ended.err, StartsWith("fathom: error: "));
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  }

  // Of addresses, for the program and its libraries.
  // The OpenBLAS of Debian 13 wants its first buffer before main, and asks for it for ever.
  std::size_t least_megabytes_to_start() {
    surroundings_.processor_s = 5;
    for (std::size_t megabytes = 100; megabytes < 4000; megabytes += 10) {
      surroundings_.address_space_bytes = megabytes << 20U;
      if (fathom({"--version"}).status != 0) continue;
      surroundings_.processor_s = 0;
      return megabytes;
    }
    return 0;
  }
};

// The libraries alone take more than 100 MB of addresses, another number on every machine. With
// little more, something fails on one of the threads; one that waited for another would keep the
// program for ever.
TEST_F(Failures, TooLittleMemoryEndsTheProgram) {
  if (std::string(FATHOM_TEST_PRELOADED).empty()) GTEST_SKIP() << "a sanitizer takes terabytes";
  write("c.yaml", kSmallSurvey);
  write("s.yaml", std::string(kSmallSurvey) + "estimators: [{type: ekf}]\ntrials: 4\njobs: 2\n");
  const std::vector<Arguments> commands{{"run", "c.yaml", "--out", "out"},
                                        {"compare", "s.yaml", "--out", "study", "--no-cache"}};
  const std::size_t least = least_megabytes_to_start();
  ASSERT_GT(least, 0U);
  for (const Arguments& command : commands) {
    for (const std::size_t more : {10U, 40U, 70U, 100U}) {
      surroundings_.address_space_bytes = (least + more) << 20U;
      const Ended ended = fathom(command);
      EXPECT_EQ(ended.status, 1) << least << " MB and " << more;
      expect_one_line(ended);
    }
  }
}

// /dev/full takes nothing, as a disk that is full does.
TEST_F(Failures, LostOutputIsNoSuccess) {
  write("g.g2o", kTwoPoses);
  write("c.yaml", kSmallSurvey);
  write("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n");
  surroundings_.standard_output = "/dev/full";
  const std::vector<Arguments> commands{{"--version"},
                                        {"--help"},
                                        {"run", "--help"},
                                        {"list", "estimators"},
                                        {"check", "g.g2o"},
                                        {"evaluate", "a.tum", "a.tum"},
                                        {"solve", "g.g2o", "--out", "solved"},
                                        {"run", "c.yaml", "--out", "run"},
                                        {"simulate", "c.yaml", "--out", "data"}};
  for (const Arguments& command : commands) {
    const Ended ended = fathom(command);
    EXPECT_EQ(ended.status, 2) << command[0];
    expect_one_line(ended);
  }
}

// `ulimit -f`: the write fails, and no signal ends the program with its lock in place.
TEST_F(Failures, AFileThatMayNotGrowIsAFailedWrite) {
  write("log.yaml",
        "dataset: {type: simulated_log, mission: {legs: 2}}\nestimators: [{type: ekf}]\n"
        "trials: 20\n");
  surroundings_.file_bytes = std::size_t{128} << 10U;
  const Ended ended = fathom({"compare", "log.yaml", "--out", "out"});
  EXPECT_EQ(ended.status, 2);
  expect_one_line(ended);
  EXPECT_FALSE(tree().contains("out/results.lock"));
}

TEST_F(Failures, AStudyThatIsStoppedBeforeItsFirstRunNamesNoStore) {
  write("s.yaml", std::string(kSmallSurvey) + "estimators: [{type: ekf}]\n");
  bool is_asked = false;
  const Ended ended = fathom({"compare", "s.yaml", "--out", "out"}, [&](pid_t id) {
    if (is_asked || !tree().contains("out/results.sqlite")) return;
    is_asked = true;
    ::kill(id, SIGTERM);
  });
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.err, ::testing::EndsWith("fathom: stopped before a run was stored.\n"));
  EXPECT_EQ(tree(), std::set<std::string>{"s.yaml"});
}

TEST_F(Failures, AnEmptyNameIsNoDefault) {
  for (const Arguments& command : std::vector<Arguments>{{"run", ""},
                                                         {"compare", ""},
                                                         {"simulate", ""},
                                                         {"solve", ""},
                                                         {"check", ""},
                                                         {"report", ""},
                                                         {"select", ""},
                                                         {"mosaic", ""},
                                                         {"run", "c.yaml", "--out", ""},
                                                         {"run", "c.yaml", "--seed", ""}}) {
    EXPECT_THAT(refusal(command), ::testing::HasSubstr("expected")) << command[0];
  }
}

}  // namespace
}  // namespace fathom::test
