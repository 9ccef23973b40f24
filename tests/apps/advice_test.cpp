// The line that says which back end suits a log: of check and of select; the studies of its rule.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/results/result_store.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class AdviceLine : public CommandLine {};

TEST_F(AdviceLine, CheckAndSelectSayTheSameOfAGraph) {
  write("g.g2o", square_graph(250, 10));
  const std::string line = fathom_done({"select", "g.g2o"}).out;
  EXPECT_THAT(line, AllOf(StartsWith("for this log: incremental_smoother, since its loops miss by "
                                     "up to 0.0"),
                          HasSubstr("; 15 loops, 0.06 a keyframe, the longest over "),
                          ContainsRegex(" sigma of a loop, so [^\n]+\n$")));
  EXPECT_THAT(fathom_done({"check", "g.g2o"}).out, HasSubstr("\n" + line));
  EXPECT_EQ(fathom_done({"select", "g.g2o", "--quiet"}).out, "");
}

TEST_F(AdviceLine, SelectTakesTheFolderOfARun) {
  write("g.g2o", square_graph(250, 10));
  write("c.yaml", "dataset: {type: g2o, path: g.g2o}\nestimator: {type: ekf}\n");
  fathom_done({"run", "c.yaml", "--out", "run", "--quiet"});
  EXPECT_EQ(fathom_done({"select", "run"}).out, fathom_done({"select", "g.g2o"}).out);
}

TEST_F(AdviceLine, AGraphWithoutLoopsHasNoTerms) {
  write("g.g2o", kTwoPoses);
  EXPECT_EQ(fathom_done({"select", "g.g2o"}).out,
            "for this log: incremental_smoother, since no loop closes a cycle, so nothing bends "
            "the map\n");
}

TEST_F(AdviceLine, WhatIsSaidOfAStudyIsRefusedOfALog) {
  write("g.g2o", square_graph(250, 10));
  for (const Arguments& flags : {Arguments{"--require", "total_ms<=1"},
                                 Arguments{"--minimise", "total_ms"}, Arguments{"--where", "a=1"},
                                 Arguments{"--allow-failures", "0.1"}, Arguments{"--out", "out"}}) {
    Arguments arguments{"select", "g.g2o"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    EXPECT_THAT(refusal(arguments), AllOf(StartsWith("g.g2o: is no study"), HasSubstr("--quiet")));
  }
  write("broken.g2o", "EDGE_SE2 0 1 1 0\n");
  EXPECT_THAT(refusal({"select", "broken.g2o"}), StartsWith("broken.g2o:1: "));
}

// Recorded headings of a kite: 2.5° a step, so that a loop over the whole path is off by far.
TEST_F(AdviceLine, OfASurveyItGoesByDeadReckoning) {
  FATHOM_REQUIRE_DATA("copr");
  EXPECT_THAT(fathom_done({"select", data_path("copr").string()}).out,
              AllOf(StartsWith("for this survey: sparse_gauss_newton, since dead reckoning leaves "
                               "a heading sigma of 0.258 rad over the 109 m between"),
                    HasSubstr("beyond 0.3 rad")));
}

// Small. The log of a study has its terms where it has a loop.
TEST_F(AdviceLine, StudiesOfTheRuleRun) {
  const std::string studies = std::string(FATHOM_SOURCE_DIR) + "/configs/studies/";
  fathom_done({"compare", studies + "which_back_end.yaml", "--out", "rule", "--quiet", "--set",
               "trials=1", "--set", "dataset.mission.legs=3", "--set",
               "dataset.mission.leg_length_m=8", "--set", "dataset.mission.loop_length_m=12",
               "--set", "dataset.mission.loop_overrun_m=3"});
  EXPECT_EQ(ResultStore::open(path("rule")).runs().size(), 36u * 8u);
  EXPECT_GT(json_of("rule/ekf/metrics.json").at("loop_misfit_rad").get<double>(), 0.0);
  EXPECT_GT(json_of("rule/ekf/metrics.json").at("loop_curvature").get<double>(), 0.0);
  fathom_done({"compare", studies + "few_loops.yaml", "--out", "few", "--quiet", "--set",
               "dataset.mission.legs=2", "--set", "dataset.mission.leg_length_m=4"});
  EXPECT_EQ(ResultStore::open(path("few")).runs().size(), 4u * 5u);
}

}  // namespace
}  // namespace fathom::test
