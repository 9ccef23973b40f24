// Shards of a study through the real command line: any number, in any order, killed half-way.

#include <SQLiteCpp/SQLiteCpp.h>
#include <algorithm>
#include <csignal>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/study_content.hpp"
#include "fathom/core/files.hpp"
#include "fathom/estimators/builtin.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Shards : public CommandLine {
 protected:
  void SetUp() override { write("s.yaml", kStudy); }

  static Arguments shard(std::size_t k, std::size_t n, const Arguments& more = {}) {
    Arguments all{"compare", "s.yaml",     "--shard",    number(k) + "/" + number(n),
                  "--out",   folder(k, n), "--scratch",  "disk",
                  "--cache", "cache",      "--no-mosaic"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  static std::string number(std::size_t value) { return std::to_string(value); }
  static std::string folder(std::size_t k, std::size_t n) {
    return "of-" + number(n) + "/" + number(k);
  }
  static Arguments merge(std::size_t n, const std::string& out, bool backwards = false) {
    Arguments all{"merge"};
    for (std::size_t k = 1; k <= n; ++k) all.push_back(folder(backwards ? n + 1 - k : k, n));
    all.insert(all.end(), {"--out", out});
    return all;
  }
};

TEST_F(Shards, MergeToTheContentOfAnUndividedRunWhateverTheirNumberAndOrder) {
  fathom_done({"compare", "s.yaml", "--out", "whole", "--cache", "cache", "--no-mosaic"});
  for (const std::size_t n : {1u, 2u, 7u, 64u}) {
    for (std::size_t k = 1; k <= n; ++k) fathom_done(shard(k, n));
    fathom_done(merge(n, "merged-" + number(n)));
    fathom_done(merge(n, "backwards-" + number(n), true));
    EXPECT_EQ(content(path("merged-" + number(n))), content(path("whole"))) << n;
    EXPECT_EQ(content(path("backwards-" + number(n))), content(path("whole"))) << n;
  }
  // What is written of the study, too, and of its example.
  for (const std::string name :
       {"report.html", "runs.csv", "tables.tex", "table.txt", "trajectories.png",
        "ekf/measurements.g2o", "ekf/trajectory.tum"}) {
    EXPECT_TRUE(fs::exists(path("merged-7/" + name))) << name;
  }
  EXPECT_EQ(read_file(path("merged-7/ekf/trajectory.tum")),
            read_file(path("whole/ekf/trajectory.tum")));
  EXPECT_TRUE(fs::is_empty(path("disk")));
  EXPECT_FALSE(fs::exists(path("of-7/1/report.html")));
}

TEST_F(Shards, AKilledOneIsSimplyRunAgain) {
  if (std::string(FATHOM_TEST_PRELOADED).empty()) GTEST_SKIP() << "not with a sanitizer";
  fathom_done({"compare", "s.yaml", "--out", "whole", "--cache", "cache", "--no-mosaic"});
  std::mt19937 random(7);
  for (int i = 0; i < 6; ++i) {
    surroundings_.environment = {{"LD_PRELOAD", FATHOM_TEST_PRELOADED},
                                 {"FATHOM_KILL_AT_WRITE", std::to_string(20 + random() % 120)}};
    EXPECT_EQ(fathom(shard(2, 2)).status, 128 + SIGKILL);
  }
  surroundings_ = {};
  EXPECT_THAT(fathom_done({"status", folder(2, 2)}).out, Not(HasSubstr("running")));
  fathom_done(shard(2, 2));
  fathom_done(shard(1, 2));
  fathom_done(merge(2, "merged"));
  EXPECT_EQ(content(path("merged")), content(path("whole")));
}

TEST_F(Shards, WhatIsMissingIsListedWithTheCommandThatDoesIt) {
  fathom_done(shard(1, 3));
  fathom_done(shard(3, 3));
  const Ended ended = fathom({"merge", folder(3, 3), folder(1, 3), "--out", "merged"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("shard 2/3: all runs: fathom compare s.yaml --shard 2/3 --out "
                                   "of-3/2 --scratch disk --cache cache --no-mosaic\n"));
  EXPECT_THAT(ended.out, HasSubstr("not run"));
  const std::string status = fathom_done({"status", folder(1, 3), folder(2, 3), folder(3, 3)}).out;
  EXPECT_THAT(status, AllOf(HasSubstr("1/3"), HasSubstr("no such folder"), HasSubstr("done"),
                            HasSubstr("shard 2/3: all runs: fathom compare")));
  fathom_done(shard(2, 3));
  fathom_done({"merge", folder(2, 3), "--out", "merged"});
  EXPECT_THAT(fathom_done({"status", "merged"}).out,
              AllOf(HasSubstr("1/3 2/3 3/3"), HasSubstr(" 0 are left")));
  // What two folders have is one run.
  const std::string once = fathom_done({"status", "merged"}).out;
  const std::string twice = fathom_done({"status", folder(1, 3), folder(3, 3), "merged"}).out;
  EXPECT_EQ(twice.substr(twice.find("\n\n")), once.substr(once.find("\n\n")));
  // Another study is none of its runs, though it has the same title and as many.
  fathom_done({"compare", "s.yaml", "--seed", "9", "--out", "other", "--no-mosaic"});
  const std::string both = fathom_done({"status", "merged/results.sqlite", "other"}).out;
  EXPECT_THAT(both, AllOf(HasSubstr("\n'merged': " + once.substr(once.find("\n\n") + 2)),
                          HasSubstr("\n'other': ")));
  const std::size_t first = both.find("runs are done");
  EXPECT_NE(both.find("runs are done", first + 1), std::string::npos);
}

TEST_F(Shards, CostsOfOtherProcessorsAreKeptApart) {
  for (const std::size_t k : {1u, 2u, 3u}) fathom_done(shard(k, 3));
  // As if the third had been made elsewhere, by a program that kept no checksum of manifests.
  SQLite::Database((path(folder(3, 3)) / "results.sqlite").string(), SQLite::OPEN_READWRITE)
      .exec(
          "UPDATE session SET manifest = json_set(manifest, '$.machine.cpu', 'another processor'); "
          "DELETE FROM study WHERE key LIKE 'checksum of session%'");
  const std::string merged = fathom_done(merge(3, "merged")).out;
  EXPECT_THAT(merged, AllOf(HasSubstr("from 2 kinds of processor"),
                            HasSubstr("those of other processors are not averaged with them")));
  const std::string table = read_file(path("merged/table.txt"));
  const std::size_t apart = table.find("Costs on another processor");
  ASSERT_NE(apart, std::string::npos);
  EXPECT_THAT(table.substr(apart), AllOf(HasSubstr("update time"), Not(HasSubstr("ATE RMSE"))));
  // The mean of a cost is over the runs of one kind alone, and so is that of summary.csv.
  EXPECT_THAT(read_file(path("merged/summary.csv")), HasSubstr("another processor"));
  EXPECT_THAT(read_file(path("merged/report.html")),
              HasSubstr("those of other processors are not averaged"));
  EXPECT_THAT(fathom_done({"select", "merged", "--minimise", "total_ms"}).out,
              HasSubstr("2 kinds of processor"));
}

TEST_F(Shards, RegistrationsAreMadeInPartsAndThenOnlyRead) {
  for (const std::string k : {"1", "2"}) {
    fathom_done(
        {"compare", "s.yaml", "--only-registrations", "--shard", k + "/2", "--cache", "r" + k});
  }
  EXPECT_FALSE(fs::exists(path("runs")));
  EXPECT_THAT(fathom_done({"merge", "r1", "r2", "--out", "all"}).out,
              HasSubstr("registrations are in all"));
  const std::string before = read_file(path("all/registrations.sqlite"));
  const Arguments reading{"compare",           "s.yaml", "--out",      "a",
                          "--read-only-cache", "all",    "--no-mosaic"};
  fathom_done(reading);
  fathom_done({"compare", "s.yaml", "--out", "b", "--no-cache", "--no-mosaic"});
  EXPECT_EQ(content(path("a")), content(path("b")));
  EXPECT_EQ(read_file(path("all/registrations.sqlite")), before);
  EXPECT_FALSE(fs::exists(path("all/registrations.sqlite-wal")));
}

TEST_F(Shards, BadOnesAreRefusedByName) {
  EXPECT_THAT(refusal({"compare", "s.yaml", "--shard", "4/3", "--out", "x"}),
              StartsWith("--shard: '4/3' is no part of a study; expected K/N with K from 1 to N"));
  EXPECT_THAT(
      refusal({"compare", "s.yaml", "--shard", "2/3", "--read-only-cache", "gone", "--out", "x"}),
      AllOf(StartsWith("shard 2/3: gone: there is no registrations.sqlite"),
            HasSubstr("fathom merge")));
  EXPECT_THAT(refusal({"compare", "s.yaml", "--scratch", "x", "--out", "y"}),
              StartsWith("--scratch: goes with --shard"));
  EXPECT_THAT(refusal({"merge", "nowhere", "--out", "x"}), StartsWith("shard nowhere: "));
  fathom_done(shard(1, 2));
  write("other.yaml", std::string(kStudy) + "seed: 9\n");
  fathom_done({"compare", "other.yaml", "--shard", "2/2", "--out", "other", "--no-mosaic"});
  EXPECT_THAT(refusal({"merge", folder(1, 2), "other", "--out", "x"}),
              AllOf(StartsWith("shard "), HasSubstr("is of another study"), HasSubstr("seed: ")));
  EXPECT_THAT(
      refusal({"compare", "other.yaml", "--shard", "1/2", "--out", folder(1, 2)}),
      AllOf(StartsWith("shard 1/2: "), HasSubstr("another configuration"), HasSubstr("seed: ")));
}

TEST_F(Shards, ATornOneIsNamedWithItsRemedy) {
  fathom_done(shard(1, 2));
  fathom_done(shard(2, 2));
  const fs::path file = path(folder(2, 2)) / "results.sqlite";
  const std::string whole = read_file(file);
  std::ofstream(file, std::ios::binary | std::ios::trunc) << whole.substr(0, whole.size() / 2);
  EXPECT_THAT(refusal(merge(2, "merged")),
              AllOf(StartsWith("shard " + folder(2, 2)), HasSubstr("damaged")));
  const Ended status = fathom({"status", folder(1, 2), folder(2, 2)});
  EXPECT_EQ(status.status, 1);
  EXPECT_THAT(status.out, HasSubstr("damaged"));
  EXPECT_THAT(refusal(shard(2, 2)), AllOf(StartsWith("shard 2/2: "), HasSubstr("damaged")));
  fs::remove_all(path(folder(2, 2)));
  fathom_done(shard(2, 2));
  fathom_done(merge(2, "merged"));
}

TEST_F(Shards, TwoOnOneFolderAreRefused) {
  // So many trials that the first is at work, on any machine, until it is told to end.
  const Arguments many{"--trials", "20000"};
  bool is_tried = false;
  const Ended first = fathom(shard(1, 1, many), [&](pid_t process) {
    if (is_tried || !fs::exists(path(folder(1, 1)) / "results.owner")) return;
    is_tried = true;
    Arguments elsewhere = shard(1, 1, many);
    std::ranges::replace(elsewhere, std::string("disk"), std::string("another disk"));
    const Ended second = fathom(elsewhere);
    EXPECT_EQ(second.status, 2);
    EXPECT_THAT(second.err,
                AllOf(StartsWith("fathom: error: shard 1/1: "),
                      HasSubstr("is at work on it; wait for it, or use another --out")));
    EXPECT_THAT(fathom_done({"status", folder(1, 1)}).out, HasSubstr("running: process "));
    ::kill(process, SIGINT);
  });
  EXPECT_EQ(first.status, 130) << first.err;
  EXPECT_TRUE(is_tried);
  // Both count runs of estimators.
  const std::size_t at = first.err.find("stopped; ") + 9;
  const std::string count = first.err.substr(at, first.err.find(" runs are in ", at) - at);
  EXPECT_THAT(fathom_done({"status", folder(1, 1)}).out, HasSubstr("\n" + count + " of "));
}

TEST_F(Shards, WhatAStudyTakesIsEstimatedFromAFewTrials) {
  const std::string text = fathom_done({"estimate", "s.yaml", "--shards", "4"}).out;
  EXPECT_THAT(
      text, AllOf(HasSubstr("processor hours"),
                  HasSubstr("10 trials with " +
                            std::to_string(builtin_estimators().entries().size()) + " estimators"),
                  HasSubstr("From 2 trials that were run here"),
                  HasSubstr("#SBATCH --array=1-4 --cpus-per-task=1 --time=")));
  // A trial is not cut.
  EXPECT_THAT(fathom_done({"estimate", "s.yaml", "--shards", "64"}).out,
              AllOf(HasSubstr("in 10 shards, one for each trial"), HasSubstr("--array=1-10 ")));
  // One trial at the least, whatever the time.
  EXPECT_THAT(fathom_done({"estimate", "s.yaml", "--seconds", "0"}).out,
              HasSubstr("From 1 trial that was run here"));
  EXPECT_EQ(fathom_done({"estimate", "s.yaml", "--seconds", "0", "--quiet"}).out, "");
  EXPECT_EQ(tree(), std::set<std::string>{"s.yaml"});
  // No folder for temporary files is a fault that has a name.
  surroundings_.environment["TMPDIR"] = "/nonexistent";
  EXPECT_THAT(refusal({"compare", "s.yaml", "--shard", "1/2", "--out", "part"}),
              StartsWith("shard 1/2: TMPDIR=/nonexistent: is no folder"));
}

}  // namespace
}  // namespace fathom::test
