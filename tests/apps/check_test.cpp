// fathom check: what is in a file or folder, and all that is wrong with it.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

class Check : public CommandLine {};

TEST_F(Check, SaysWhatIsInAGraph) {
  write("g.g2o", square_graph(250, 10));
  const std::string out = fathom_done({"check", "g.g2o"}).out;
  EXPECT_THAT(out, AllOf(ContainsRegex("poses +250, the file defines no vertices"),
                         ContainsRegex("edges +264"), ContainsRegex("odometry +249"),
                         ContainsRegex("loops +15"), ContainsRegex("components +1"),
                         HasSubstr("at odometry"), HasSubstr("where a batch solve")));
}

TEST_F(Check, GivesTheCostOfTheFilesGuess) {
  // By hand: the guess is 0.5 m off along x, with an information of 4.
  write("g.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.5 0 0\nEDGE_SE2 0 1 1 0 0 4 0 0 1 0 1\n");
  const std::string out = fathom_done({"check", "g.g2o"}).out;
  EXPECT_THAT(out, AllOf(ContainsRegex("F +1 at the file's guess"),
                         ContainsRegex("F +0 at odometry"), HasSubstr("warning: no loops")));
}

TEST_F(Check, ListsEveryFaultOfABrokenGraph) {
  write("g.g2o", kTwoPoses +
                     "EDGE_SE2 0 1 1 0\n"                  // line 4: too short
                     "EDGE_SE3 0 1 1 0 0 1 0 0 1 0 1\n"    // unknown
                     "EDGE_SE2 0 1 inf 0 0 1 0 0 1 0 1\n"  // not finite
                     "EDGE_SE2 0 1 1 0 0 1 5 0 1 0 1\n"    // not positive definite
                     "EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n"    // to itself
                     "EDGE_SE2 1 8 1 0 0 1 0 0 1 0 1\n"    // undefined vertex
                     "FIX 1\n"                             // line 10: not the lowest
                     "VERTEX_SE2 5 0 0 0\n");              // a component of its own
  const Ended ended = fathom({"check", "g.g2o"});
  EXPECT_EQ(ended.status, 2);
  for (int line = 4; line <= 11; ++line) {
    EXPECT_THAT(ended.out, HasSubstr("fault: g.g2o:" + std::to_string(line) + ": "));
  }
  EXPECT_THAT(ended.err, AllOf(HasSubstr("fathom: error: g.g2o:"), HasSubstr("(8 faults in all)")));
}

// One validation for all: what a run would refuse in the middle is found here.
TEST_F(Check, RefusesTheGraphsThatRunAndSolveRefuse) {
  write("big.g2o", "EDGE_SE2 0 1 1e300 0 0 1 0 0 1 0 1\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  write("far.g2o", "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1e300 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const std::vector<std::pair<std::string, std::string>> cases{
      {"big.g2o", "F is not finite at dead reckoning"},
      {"far.g2o", "F is not finite at its vertices"}};
  for (const auto& [file, message] : cases) {
    write("c.yaml", "dataset: {type: g2o, path: " + file + "}\n");
    for (const Arguments& command :
         {Arguments{"check", file}, Arguments{"solve", file}, Arguments{"run", "c.yaml"}}) {
      const Ended ended = fathom(command);
      EXPECT_EQ(ended.status, 2) << command[0];
      EXPECT_THAT(ended.err, HasSubstr("fathom: error: " + file + ": " + message)) << command[0];
    }
  }
}

TEST_F(Check, RefusesAFolderWithAPictureThatARunRefuses) {
  const auto survey = [](int width) {
    return "dataset:\n  world: {metres_per_pixel: 0.01}\n"
           "  mission: {legs: 1, leg_length_m: 2}\n"
           "  camera: {height: 60, fx: 60, fy: 60, width: " +
           std::to_string(width) + "}\n";
  };
  write("a.yaml", survey(80));
  write("b.yaml", survey(96));
  fathom_done({"simulate", "a.yaml", "--out", "a"});
  fathom_done({"simulate", "b.yaml", "--out", "b"});
  const std::string name = "mav0/cam0/data/1000000000.png";
  std::filesystem::copy_file(path("b/" + name), path("a/" + name),
                             std::filesystem::copy_options::overwrite_existing);
  const Ended checked = fathom({"check", "a"});
  EXPECT_EQ(checked.status, 2);
  EXPECT_THAT(checked.err, HasSubstr("1000000000.png: has 96 x 60 pixels, expected"));
  EXPECT_THAT(fathom({"run", "a/run.yaml", "--set", "front_end.keyframes.separation_frames=1"}).err,
              HasSubstr("1000000000.png: has 96 x 60 pixels, expected"));
}

// There are pictures in it, which are no survey's.
TEST_F(Check, AFolderOfARunIsNoSurvey) {
  write("square.g2o", square_graph(40, 3));
  fathom_done({"run", "square.g2o", "--out", "out"});
  for (const char* command : {"check", "run"}) {
    EXPECT_EQ(refusal({command, "out"}), "out: is the folder of a run or a study, no survey\n");
  }
}

TEST_F(Check, WarnsOfInformationThatLooksWrong) {
  write("thin.g2o",
        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1e12 0 0 1 0 1\n"
        "EDGE_SE2 0 2 2 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(fathom_done({"check", "thin.g2o"}).out, HasSubstr("badly conditioned"));
  write("far.g2o",
        "EDGE_SE2 0 1 1 0 0 1e4 0 0 1e4 0 1e4\nEDGE_SE2 1 2 1 0 0 1e4 0 0 1e4 0 1e4\n"
        "EDGE_SE2 0 2 1 0 0 1e4 0 0 1e4 0 1e4\n");
  EXPECT_THAT(fathom_done({"check", "far.g2o"}).out,
              HasSubstr("warning: F per degree of freedom is "));
}

TEST_F(Check, HeadingsInDegreesAreNamed) {
  const auto turned = [](const std::string& heading) {
    const std::string information = " 1e4 0 0 1e4 0 1e4\n";
    return "EDGE_SE2 0 1 1 0 " + heading + information + "EDGE_SE2 1 2 1 0 " + heading +
           information + "EDGE_SE2 0 2 1 1 3.14159" + information;
  };
  write("degrees.g2o", turned("90"));
  EXPECT_THAT(fathom_done({"check", "degrees.g2o"}).out,
              HasSubstr("warning: 2 edges with a heading beyond 2 pi: headings look like degrees"));
  // What fits is a turn too much, and no degrees.
  write("radians.g2o", turned("7.853982"));
  EXPECT_THAT(fathom_done({"check", "radians.g2o"}).out, Not(HasSubstr("degrees,")));
}

TEST_F(Check, KnowsAGraphByItsLinesAndABagByItsEnding) {
  write("square.txt", square_graph(40, 3));
  EXPECT_THAT(fathom_done({"check", "square.txt"}).out, HasSubstr("pose graph"));
  write("dive.db3", "SQLite format 3");
  EXPECT_THAT(refusal({"check", "dive.db3"}), HasSubstr("is a bag; fathom import"));
}

TEST_F(Check, SaysWhatIsInATrajectoryOrConfiguration) {
  write("a.tum", "0 0 0 0 0 0 0 1\n1 3 4 0 0 0 0 1\n");
  EXPECT_THAT(fathom_done({"check", "a.tum"}).out,
              AllOf(ContainsRegex("poses +2"), ContainsRegex("path +5[.]000 m")));
  write("c.yaml", "seed: 5\n");
  EXPECT_THAT(fathom_done({"check", "c.yaml"}).out,
              AllOf(HasSubstr("configuration for 'run'"), HasSubstr("seed: 5")));
  write("c.yml", "estimators: [{type: ekf, name: a}]\n");
  EXPECT_THAT(fathom_done({"check", "c.yml"}).out,
              AllOf(HasSubstr("study for 'compare'"), HasSubstr("estimator a: ekf")));
}

}  // namespace
}  // namespace fathom::test
