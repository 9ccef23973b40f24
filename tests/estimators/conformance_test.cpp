// The contract, every clause of it over every estimator of the registry.

#include "fathom/harness/conformance.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"

namespace fathom::test {
namespace {

struct Case {
  std::string estimator;
  ConformanceClause clause;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    for (const ConformanceClause& clause : conformance_clauses()) {
      all.push_back({entry.name, clause});
    }
  }
  return all;
}

class Conformance : public testing::TestWithParam<Case> {};

// A fix is linear in (x, y) and not in a twist: one linearisation ends beside one of a nanometre
// (docs/estimators/invariant_ekf.md, Fixes).
bool is_known_breach(const Case& of) {
  return of.estimator == "invariant_ekf" && of.clause.name == "nanometre_fixes";
}

TEST_P(Conformance, Keeps) {
  const auto& [estimator, clause] = GetParam();
  const ConformanceVerdict verdict =
      conformance_of(builtin_estimators().find(estimator), clause.name);
  if (verdict.conformity == Conformity::not_applicable) {
    GTEST_SKIP() << "does not apply: " << verdict.how;
  }
  if (is_known_breach(GetParam())) {
    EXPECT_EQ(verdict.conformity, Conformity::broken) << "it is a breach no more";
    return;
  }
  EXPECT_EQ(verdict.conformity, Conformity::kept)
      << estimator << " breaks " << clause.name << ": " << verdict.how << "\n"
      << clause.rule;
}

INSTANTIATE_TEST_SUITE_P(Every, Conformance, testing::ValuesIn(cases()), [](const auto& each) {
  return each.param.estimator + "__" + each.param.clause.name;
});

}  // namespace
}  // namespace fathom::test
