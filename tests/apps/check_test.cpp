// fathom check: what is in a file or folder, and all that is wrong with it.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

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
                     "VERTEX_SE2 5 0 0 0\n");              // without odometry
  const Ended ended = fathom({"check", "g.g2o"});
  EXPECT_EQ(ended.status, 2);
  // And one that follows from line 9: pose 8 has no odometry either.
  for (int line = 4; line <= 11; ++line) {
    EXPECT_THAT(ended.out, HasSubstr("fault: g.g2o:" + std::to_string(line) + ": "));
  }
  EXPECT_THAT(ended.err, AllOf(HasSubstr("fathom: error: g.g2o:"), HasSubstr("(9 faults in all)")));
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
