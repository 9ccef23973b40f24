// Estimators that are right but for one thing: every clause of the contract finds one of them out.

#include <memory>
#include <set>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/conformance.hpp"
#include "tests/estimators/breaches.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

// It has a batch mode, losses and a gate, so that every clause applies.
const EstimatorEntry& good() {
  return builtin_estimators().find("sparse_gauss_newton");
}

const std::vector<Breach>& breaches() {
  static const std::vector<Breach> all = [] {
    std::vector<Breach> joined;
    for (const auto part : {estimate_breaches, failure_breaches, loop_breaches, covariance_breaches,
                            absolute_breaches}) {
      for (Breach& breach : part()) joined.push_back(std::move(breach));
    }
    return joined;
  }();
  return all;
}

TEST(ConformanceBreaches, EachIsFoundByItsClause) {
  for (const auto& [clause, how, spoils] : breaches()) {
    const ConformanceVerdict verdict = conformance_of(spoilt(good(), spoils), clause);
    EXPECT_EQ(verdict.conformity, Conformity::broken) << clause << ", " << how;
    EXPECT_THAT(verdict.how, HasSubstr(how)) << clause;
  }
}

TEST(ConformanceBreaches, EveryClauseHasOneAndIsKeptByTheEstimatorUnspoilt) {
  std::set<std::string> seen;
  for (const Breach& breach : breaches()) seen.insert(breach.clause);
  std::set<std::string> names;
  for (const ConformanceClause& clause : conformance_clauses()) {
    EXPECT_TRUE(names.insert(clause.name).second) << clause.name << ": two have this name";
    EXPECT_FALSE(clause.rule.empty()) << clause.name;
    const ConformanceVerdict verdict = conformance_of(spoilt(good(), {}), clause.name);
    EXPECT_EQ(verdict.conformity, Conformity::kept) << clause.name << ": " << verdict.how;
  }
  EXPECT_EQ(seen, names);
}

TEST(ConformanceBreaches, AFactoryThatFailsBreaksEveryClauseThatApplies) {
  EstimatorEntry nothing = good();
  nothing.create = [](const auto&, const auto&) { return std::unique_ptr<Estimator>(); };
  EstimatorEntry refusing = good();
  refusing.create = [](const auto&, const auto&) -> std::unique_ptr<Estimator> { throw 7; };
  for (const ConformanceClause& clause : conformance_clauses()) {
    EXPECT_THAT(conformance_of(nothing, clause.name).how, HasSubstr("returned no estimator"));
    EXPECT_THAT(conformance_of(refusing, clause.name).how, HasSubstr("is no std::exception"));
  }
}

TEST(ConformanceBreaches, AClauseOnWhatAnEstimatorLacksDoesNotApply) {
  EstimatorEntry plain = good();
  plain.can_batch = false;
  plain.options.clear();
  plain.create = [](const EstimatorSetup& setup, const EstimatorValues& values) {
    return good().create(setup, values);
  };
  std::set<std::string> reasons;
  for (const ConformanceClause& clause : conformance_clauses()) {
    if (clause.name == "beyond_doubles") continue;  // of no option, and long
    const ConformanceVerdict verdict = conformance_of(plain, clause.name);
    if (verdict.conformity == Conformity::not_applicable) reasons.insert(verdict.how);
  }
  EXPECT_THAT(reasons, testing::UnorderedElementsAre(
                           "no batch mode", "no option 'gate_probability'", "no option 'loss'",
                           "no option 'gate_probability' or 'max_iterations'"));
}

TEST(ConformanceBreaches, AnUnknownClauseIsRefused) {
  EXPECT_THROW(conformance_of(good(), "rotated_wordl"), InputError);
}

}  // namespace
}  // namespace fathom::test
