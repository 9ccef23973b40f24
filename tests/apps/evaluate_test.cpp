// evaluate: the errors of a written trajectory.

#include <regex>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Commands, EvaluateAgreesWithTheRun) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  const Ended ended = fathom_done({"evaluate", "out/trajectory.tum", "out/ground_truth.tum",
                                   "--step", "1", "--step", "3", "--distance", "1.5"});
  std::smatch found;
  ASSERT_TRUE(
      std::regex_search(ended.out, found, std::regex(R"(mean position error \(m\) +([0-9.e-]+))")));
  const double expected = json_of("out/metrics.json").at("mean_position_error_m");
  EXPECT_NEAR(std::stod(found[1]), expected, 1e-5 * expected);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("11 of 11 poses"), HasSubstr("3 poses"),
                               HasSubstr("1.50 m"), HasSubstr("alignment origin")));
}

TEST_F(Commands, EvaluateSaysOfASinglePoseThatItHasNoError) {
  write("estimate.tum", "0 1 2 0 0 0 0 1\n");
  write("reference.tum", "0 4 6 0 0 0 0 1\n1 5 6 0 0 0 0 1\n");
  for (const char* alignment : {"origin", "se2"}) {
    const std::string out =
        fathom_done({"evaluate", "estimate.tum", "reference.tum", "--alignment", alignment}).out;
    EXPECT_THAT(out, HasSubstr("no error can be given: alignment " + std::string(alignment)));
    EXPECT_THAT(out, Not(HasSubstr("mean position error")));
  }
  const std::vector<std::string> as_it_is{"evaluate", "estimate.tum", "reference.tum",
                                          "--alignment", "none"};
  EXPECT_TRUE(std::regex_search(fathom_done(as_it_is).out,
                                std::regex(R"(mean position error \(m\) +5\.0)")));
}

}  // namespace
}  // namespace fathom::test
