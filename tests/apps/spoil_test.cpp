// spoil: false loops in a graph, and solve that is judged by them.

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(Commands, SpoilRefusesWhatItCannotDo) {
  write("g.g2o", square_graph(160, 3));
  write("open.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const auto refused = [&](const std::string& graph, const std::string& share) {
    return refusal({"spoil", graph, "--share", share, "--out", "o.g2o"});
  };
  EXPECT_THAT(refused("g.g2o", "nan"), HasSubstr("--share: expected a number"));
  EXPECT_THAT(refused("g.g2o", "0.95"), HasSubstr("--share"));
  EXPECT_THAT(refused("open.g2o", "0.3"), HasSubstr("open.g2o: has no loop"));
}

TEST_F(Commands, SpoilAddsFalseLoopsThatSolveIsJudgedBy) {
  write("g.g2o", square_graph(160, 3));
  const auto spoilt = [&](const std::string& seed, const std::string& out) {
    return fathom_done({"spoil", "g.g2o", "--share", "0.25", "--kind", "grouped", "--group-size",
                        "2", "--seed", seed, "--out", out});
  };
  // 20 loops of the square, of which a third are added.
  EXPECT_THAT(spoilt("1", "a.g2o").out,
              AllOf(HasSubstr("7 false loops, grouped, among 27"), HasSubstr("a.false_loops.csv")));
  spoilt("1", "b.g2o");
  spoilt("2", "c.g2o");
  EXPECT_EQ(bytes_of("a.g2o"), bytes_of("b.g2o"));
  EXPECT_EQ(bytes_of("a.false_loops.csv"), bytes_of("b.false_loops.csv"));
  EXPECT_NE(bytes_of("a.g2o"), bytes_of("c.g2o"));
  const std::vector<std::string> solve{
      "solve", "a.g2o", "--estimator", "sparse_gauss_newton", "--false-loops", "a.false_loops.csv"};
  std::vector<std::string> robust = solve;
  robust.insert(robust.end(), {"--set", "estimator.loss=truncated", "--out", "robust"});
  EXPECT_THAT(fathom_done(robust).out, HasSubstr("0 of 7 false loops kept, 0 right ones lost"));
  EXPECT_EQ(json_of("robust/metrics.json").at("false_loops_kept"), 0);
  std::vector<std::string> plain = solve;
  plain.insert(plain.end(), {"--out", "plain"});
  EXPECT_THAT(fathom_done(plain).out, HasSubstr("7 of 7 false loops kept"));
}

// A solve from the file's own start is one of the spoilt file, too.
TEST_F(Commands, SpoilKeepsTheGuessOfTheFile) {
  write("g.g2o",
        "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1.5 0.25 0\nVERTEX_SE2 2 0.5 1 2\n"
        "EDGE_SE2 0 1 1 0 1.5 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 1.5 1 0 0 1 0 1\n"
        "EDGE_SE2 0 2 1 1 3 1 0 0 1 0 1\n");
  fathom_done({"spoil", "g.g2o", "--share", "0", "--out", "o.g2o"});
  EXPECT_THAT(bytes_of("o.g2o"),
              AllOf(HasSubstr("VERTEX_SE2 1 1.5 0.25 0\n"), HasSubstr("VERTEX_SE2 2 0.5 1 2\n")));
}

TEST_F(Commands, SpoilRefusesWhatItWouldIgnore) {
  write("g.g2o", square_graph(160, 3));
  EXPECT_THAT(refusal({"spoil", "g.g2o", "--reach", "5", "--out", "a.g2o"}),
              HasSubstr("--reach: only --kind local"));
  EXPECT_THAT(refusal({"spoil", "g.g2o", "--group-size", "5", "--out", "a.g2o"}),
              HasSubstr("--group-size: only --kind grouped"));
}

}  // namespace
}  // namespace fathom::test
