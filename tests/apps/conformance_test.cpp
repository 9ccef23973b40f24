// conformance: estimators held against the contract.

#include "fathom/harness/conformance.hpp"

#include <regex>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ConformanceCommand : public CommandLine {};

TEST_F(ConformanceCommand, SumsUpEachEstimatorThatIsNamed) {
  const std::string out = fathom_done({"conformance", "ekf", "sparse_gauss_newton"}).out;
  const std::regex summaries(
      "ekf: keeps (\\d+) of \\1 clauses, 4 do not apply: no option 'loss', no batch mode\n"
      "sparse_gauss_newton: keeps (\\d+) of \\2 clauses\n");
  EXPECT_TRUE(std::regex_match(out, summaries)) << out;
}

TEST_F(ConformanceCommand, ListsTheClausesWithTheirRules) {
  const std::string out = fathom_done({"conformance", "--list"}).out;
  for (const ConformanceClause& clause : conformance_clauses()) {
    EXPECT_THAT(out, AllOf(HasSubstr(clause.name), HasSubstr(clause.rule)));
  }
}

TEST_F(ConformanceCommand, RefusesANameThatThereIsNotBeforeItBegins) {
  EXPECT_THAT(refusal({"conformance", "ekf", "efk"}),
              HasSubstr("unknown estimator 'efk'; did you mean 'ekf'?"));
  EXPECT_THAT(refusal({"conformance", "ekf", "--list"}), HasSubstr("--list"));
}

}  // namespace
}  // namespace fathom::test
