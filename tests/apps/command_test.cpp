// The estimator `command`: other programs, through the real command line.

#include <algorithm>
#include <cerrno>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/processes.hpp"
#include "fathom/results/result_store.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kTriangle =
    "VERTEX_SE2 0 2 1 3.1\nVERTEX_SE2 1 1 1 2\nVERTEX_SE2 2 1 2 0\nFIX 0\n"
    "EDGE_SE2 0 1 1 0.1 2.1 9 1 0.5 8 0.2 30\nEDGE_SE2 1 2 1 0 2.0 9 1 0.5 8 0.2 30\n"
    "EDGE_SE2 2 0 1.1 0 2.2 9 1 0.5 8 0.2 30\n";

const std::string kByFiles = FATHOM_EXAMPLES "command/by_files.sh";
const std::string kByLines = FATHOM_EXAMPLES "command/by_lines.py";

class CommandProgram : public CommandLine {
 protected:
  CommandProgram() { surroundings_.environment["FATHOM"] = FATHOM_BINARY; }

  /// A script in the folder; what starts it.
  std::string script(const std::string& name, const std::string& text) {
    write(name, text);
    fs::permissions(path(name), fs::perms::owner_all);
    return path(name).string();
  }

  Ended solve(const std::string& graph, const std::string& command, const Arguments& more = {}) {
    Arguments all{"solve", graph, "--estimator", "command",
                  "--out", "out", "--set",       "estimator.command=" + command};
    all.insert(all.end(), more.begin(), more.end());
    return fathom(all);
  }

  /// A triangle solved by a program that does not do its work: its metrics.json.
  nlohmann::json failed(const std::string& command, const Arguments& more = {}) {
    write("triangle.g2o", kTriangle);
    EXPECT_EQ(solve("triangle.g2o", command, more).status, 1);
    return json_of("out/metrics.json");
  }

  double chi2_by(const Arguments& arguments) {
    EXPECT_EQ(fathom_done(arguments).err, "");
    return json_of("out/metrics.json").at("chi2").get<double>();
  }
};

TEST_F(CommandProgram, ByFilesAndByLinesReachTheOptimum) {
  write("triangle.g2o", kTriangle);
  const double optimum = chi2_by({"solve", "triangle.g2o", "--out", "out"});
  EXPECT_GT(optimum, 1e-4);
  const std::string lines = kByLines + " " + kByFiles + " {in} {out}";
  for (const std::string& command : {kByFiles + " {input} {output}", lines}) {
    for (const std::string mode : {"batch", "incremental"}) {
      EXPECT_NEAR(chi2_by({"solve", "triangle.g2o", "--out", "out", "--estimator", "command",
                           "--set", "estimator.command=" + command, "--mode", mode}),
                  optimum, 1e-9 * optimum)
          << command << " " << mode;
      const nlohmann::json metrics = json_of("out/metrics.json");
      EXPECT_GT(metrics.at("start_up_ms").get<double>(), 0.0);
      EXPECT_GT(metrics.at("memory_bytes").get<double>(), 1e6);
      EXPECT_FALSE(metrics.contains("anees") && !metrics.at("anees").is_null());
    }
  }
}

TEST_F(CommandProgram, IntelIsSolvedByFilesAndByLines) {
  FATHOM_REQUIRE_DATA("pose_graphs/intel.g2o");
  const fs::path intel = data_path("pose_graphs/intel.g2o");
  const std::string lines = kByLines + " " + kByFiles + " {in} {out}";
  for (const std::string& command : {kByFiles + " {input} {output}", lines}) {
    EXPECT_NEAR(chi2_by({"solve", intel.string(), "--out", "out", "--estimator", "command", "--set",
                         "estimator.command=" + command}),
                45.0047, 5e-5);
  }
}

TEST_F(CommandProgram, StandsInAStudyBesideTheOthers) {
  write("s.yaml",
        "dataset:\n  type: simulated_log\n"
        "  mission: {type: sweep, legs: 3, leg_length_m: 8, leg_spacing_m: 1.0}\n"
        "  loops: {max_distance_m: 1.4}\ntrials: 2\nestimators:\n"
        "  - {type: sparse_gauss_newton}\n  - {type: command, command: '" +
            kByFiles + " {input} {output}'}\n");
  fathom_done({"compare", "s.yaml", "--out", "study"});
  EXPECT_EQ(fathom_done({"report", "study"}).err, "");
  std::map<std::string, std::vector<double>> costs;
  for (const RunRecord& run : ResultStore::open(path("study")).runs()) {
    if (run.key.estimator == "dead_reckoning") continue;
    EXPECT_EQ(run.outcome, "converged") << run.fault;
    costs[run.key.estimator].push_back(run.metrics.at("chi2"));
  }
  ASSERT_EQ(costs["command"].size(), 2u);
  for (std::size_t t = 0; t < 2; ++t) {
    EXPECT_NEAR(costs["command"][t], costs["sparse_gauss_newton"][t], 1e-6);
  }
}

TEST_F(CommandProgram, WhatItDoesWrongIsAnOutcome) {
  const auto outcome = [](const nlohmann::json& metrics) { return metrics.at("outcome"); };
  const auto fault = [](const nlohmann::json& metrics) {
    return metrics.at("fault").get<std::string>();
  };
  nlohmann::json run = failed(script("dies", "#!/bin/sh\necho no licence >&2\nkill -SEGV $$\n") +
                              " {input} {output}");
  EXPECT_EQ(outcome(run), "crashed");
  EXPECT_THAT(fault(run), AllOf(HasSubstr("signal 11"), HasSubstr("no licence")));
  run = failed(script("stops", "#!/bin/sh\necho bad graph >&2\nexit 3\n") + " {input} {output}");
  EXPECT_EQ(outcome(run), "crashed");
  EXPECT_THAT(fault(run), AllOf(HasSubstr("status 3"), HasSubstr("bad graph")));
  run = failed(script("silent", "#!/bin/sh\nexit 0\n") + " {input} {output}");
  EXPECT_EQ(outcome(run), "numerical_failure");
  EXPECT_THAT(fault(run), HasSubstr("wrote no"));
  run = failed(script("rubbish", "#!/bin/sh\necho one two three > $2\n") + " {input} {output}");
  EXPECT_THAT(fault(run), HasSubstr("its output has 0 poses, expected 3"));
  run = failed(
      script("nan", "#!/bin/sh\nfor k in 0 1 2; do echo VERTEX_SE2 $k nan 0 0; done > $2\n") +
      " {input} {output}");
  EXPECT_EQ(outcome(run), "numerical_failure");
  run = failed(script("ends", "#!/bin/sh\nexit 0\n"));
  EXPECT_EQ(outcome(run), "crashed");
  run = failed(
      script("talks", "#!/bin/sh\necho BEGIN; echo END; read a; echo BEGIN; echo hello; cat\n"));
  EXPECT_EQ(outcome(run), "numerical_failure");
  EXPECT_THAT(fault(run), HasSubstr("hello"));
}

TEST_F(CommandProgram, OneThatNeverEndsIsEndedWithAllThatItStarted) {
  const Arguments limit{"--set", "time_limit_s=1"};
  const std::string sleeps = script("sleeps", "#!/bin/sh\nsleep 7653.0625\n");
  EXPECT_EQ(failed(sleeps + " {input} {output}", limit).at("outcome"), "timed_out");
  EXPECT_EQ(failed(sleeps, limit).at("outcome"), "timed_out");
  const std::string prints = script("prints", "#!/bin/sh\nyes 7653.0625\n");
  EXPECT_EQ(failed(prints, limit).at("outcome"), "timed_out");
  EXPECT_TRUE(none_is_left("7653.0625"));
}

// Each ends the study with one line that names it, and the same command is done without it.
TEST_F(CommandProgram, FaultsOfTheEnvironmentAreNobodysResult) {
  if (std::string(FATHOM_TEST_FAULTS).empty()) GTEST_SKIP() << "not with a sanitizer";
  const std::string solver =
      script("echoes", "#!/bin/sh\n[ -e full ] && exit 1\ngrep '^VERTEX_SE2' $1 > $2\n");
  write("s.yaml",
        "dataset:\n  type: simulated_log\n"
        "  mission: {type: sweep, legs: 3, leg_length_m: 8, leg_spacing_m: 1.0}\n"
        "  loops: {max_distance_m: 1.4}\ntrials: 2\nestimators:\n"
        "  - {type: ekf}\n  - {type: command, command: '" +
            solver + " {input} {output}'}\n");
  struct Kind {
    const char* call;
    int error;
    const char* at;
    const char* said;
  };
  const auto environment = surroundings_.environment;
  const std::vector<Kind> kinds{
      {"", 0, "1", "none: is no folder for the program's files"},
      {"write", ENOSPC, "1", "input.g2o: cannot be written: No space left on device"},
      {"write", EDQUOT, "2", "room: cannot be written: Disk quota exceeded"},
      {"mkdir", EROFS, "1", "cannot be made: Read-only file system"},
      {"open", EMFILE, "1", "input.g2o: cannot be written: Too many open files"},
      {"fork", EAGAIN, "1", "no process of its own: Resource temporarily unavailable"}};
  for (const auto& [call, error, at, said] : kinds) {
    const std::string out = "study of " + std::string(said).substr(0, 5) + call;
    auto& given = surroundings_.environment;
    given = environment;
    if (*call == '\0') {
      given["TMPDIR"] = path("none").string();
    } else {
      given["LD_PRELOAD"] = FATHOM_TEST_FAULTS;
      given["FATHOM_FAULT_CALL"] = call;
      given["FATHOM_FAULT_AT"] = at;
      given["FATHOM_FAULT_COUNT"] = "1000000";
      given["FATHOM_FAULT_ERROR"] = std::to_string(error);
      if (std::string(call) != "fork") given["FATHOM_FAULT_PATH"] = "fathom-command-";
    }
    if (std::string(at) == "2") write("full", "");
    const Ended ended = fathom({"compare", "s.yaml", "--out", out});
    EXPECT_EQ(ended.status, 2) << said;
    EXPECT_THAT(ended.err, HasSubstr(said));
    EXPECT_EQ(std::ranges::count(without_notes(ended.err), '\n'), 1) << ended.err;
    given = environment;
    fs::remove(path("full"));
    EXPECT_THAT(fathom_done({"compare", "s.yaml", "--out", out}).out, HasSubstr("2/2 done"))
        << said;
  }
}

// More than a pipe holds goes in while as much comes out, and nobody waits for the other.
TEST_F(CommandProgram, PipesThatFillDoNotStopIt) {
  std::string graph;
  for (int k = 1; k <= 5000; ++k) {
    graph += "EDGE_SE2 " + std::to_string(k - 1) + " " + std::to_string(k) +
             " 1.000000001 0 0.01 11 0 0 11 0 33\n";
  }
  write("long.g2o", graph + "EDGE_SE2 5000 0 1 1 1 1 0 0 1 0 1\n");
  // It prints every line that it reads, before it answers with what it was given.
  const std::string echoes = script("echoes", R"(#!/usr/bin/env python3
import sys
poses = {}
for line in sys.stdin:
    print("heard", line, end="")
    words = line.rstrip(";\n").split()
    if words[1:2] == ["VERTEX_XYT"]:
        poses[words[2]] = " ".join(words[3:])
    if words[0] == "QUERY_STATE":
        asked = words[1:] or poses
        print("BEGIN", *(f"VERTEX_XYT {k} {poses[k]}" for k in asked), "END", sep="\n", flush=True)
)");
  const Ended ended = solve("long.g2o", echoes);
  EXPECT_EQ(ended.status, 0) << ended.err;
  const nlohmann::json metrics = json_of("out/metrics.json");
  EXPECT_DOUBLE_EQ(metrics.at("chi2").get<double>(), metrics.at("chi2_initial").get<double>());
}

TEST_F(CommandProgram, WhatCannotBeRunIsRefusedInOneLine) {
  write("triangle.g2o", kTriangle);
  const auto refused = [&](const std::string& command) {
    return refusal({"solve", "triangle.g2o", "--out", "out", "--estimator", "command", "--set",
                    "estimator.command=" + command});
  };
  EXPECT_THAT(refused("no-such-solver {input} {output}"),
              HasSubstr("'no-such-solver': there is no such program in PATH"));
  EXPECT_THAT(refused("./triangle.g2o {input} {output}"), HasSubstr("may not be executed"));
  EXPECT_THAT(refused("cat {input}"), HasSubstr("expected both, or none"));
  EXPECT_THAT(refused("cat 'x"), HasSubstr("a quote is not closed"));
  EXPECT_THAT(refused(""), HasSubstr("expected a program"));
  EXPECT_THAT(refusal({"solve", "triangle.g2o", "--out", "out", "--estimator", "command"}),
              HasSubstr("expected a program"));
  EXPECT_THAT(refusal({"conformance", "command"}), HasSubstr("another program's"));
}

}  // namespace
}  // namespace fathom::test
