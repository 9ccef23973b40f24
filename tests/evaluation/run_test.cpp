#include "fathom/evaluation/run.hpp"

#include <set>

#include <gtest/gtest.h>

#include "fathom/evaluation/metrics.hpp"

namespace fathom::test {
namespace {

// The lists of names do not compile where a member is added; then it is missing in each(), too.

TEST(Members, EachOfARunIsVisitedOnce) {
  fathom::Run run;
  const auto& [trajectory, covariances, outcome, fault, outcome_counts, loops, loop_weights,
               absolute, absolute_weights, iterations, errors, gradient_norm, is_local_minimum,
               costs, motions, chi2_initial, chi2_used, absolute_chi2_used] = run;
  const std::set<const void*> members{&trajectory,       &covariances,
                                      &outcome,          &fault,
                                      &outcome_counts,   &loops,
                                      &loop_weights,     &absolute,
                                      &absolute_weights, &iterations,
                                      &errors,           &gradient_norm,
                                      &is_local_minimum, &costs,
                                      &motions,          &chi2_initial,
                                      &chi2_used,        &absolute_chi2_used};
  std::multiset<const void*> visited;
  fathom::Run::each([&](auto member) { visited.insert(&(run.*member)); });
  EXPECT_EQ(std::set(visited.begin(), visited.end()), members);
  EXPECT_EQ(visited.size(), members.size());
}

TEST(Members, EachCostIsVisitedOnceAndIsAMetric) {
  Costs costs;
  const auto& [update_ms, add_ms, newest_covariance_ms, total_ms, candidate_covariance_ms, cpu_ms,
               covariance_ms, start_up_ms, memory_bytes] = costs;
  const std::set<const void*> members{
      &update_ms, &add_ms,        &newest_covariance_ms, &total_ms,    &candidate_covariance_ms,
      &cpu_ms,    &covariance_ms, &start_up_ms,          &memory_bytes};
  std::multiset<const void*> visited;
  Costs::each([&](const std::string& name, auto, auto, auto, auto member) {
    visited.insert(&(costs.*member));
    EXPECT_TRUE(is_cost_metric(name) || is_cost_metric(name + ".median")) << name;
  });
  EXPECT_EQ(std::set(visited.begin(), visited.end()), members);
  EXPECT_EQ(visited.size(), members.size());
}

}  // namespace
}  // namespace fathom::test
