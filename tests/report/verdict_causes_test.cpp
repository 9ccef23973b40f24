// Why estimators are overconfident, where several are.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"

namespace fathom::test {
namespace {

using ::testing::ElementsAre;

EstimatorResults overconfident(const std::string& name, HonestyCause cause, double figure) {
  EstimatorResults one = eight(name, kBest);
  one.honesty = Honesty{true, cause};
  one.consistency["anees"].moments.mean = 5.0;
  one.consistency["chi2_per_dof"].moments.mean = figure;
  one.consistency["mean_nis_truth"].moments.mean = figure;
  return one;
}

TEST(VerdictCauses, EachIsThatOfItsEstimator) {
  EXPECT_THAT(doubts_of_one(surveyed({overconfident("a", HonestyCause::misfit, 2.0),
                                      overconfident("b", HonestyCause::unknown, 2.0),
                                      overconfident("c", HonestyCause::small_registrations, 9.0)})),
              ElementsAre("Overconfident, where 1 is expected: a (ANEES 5.00), b (ANEES 5.00) and "
                          "c (ANEES 5.00). a: F per degree of freedom is 2.0: covariances of the "
                          "log are too small, or loops are false. c: The covariances of the "
                          "registrations are too small: their mean NIS against truth is 9.0, where "
                          "3 is expected."));
}

TEST(VerdictCauses, OneThatAllShareIsGivenOnce) {
  EXPECT_THAT(doubts_of_one(surveyed({overconfident("a", HonestyCause::misfit, 2.0),
                                      overconfident("b", HonestyCause::misfit, 2.0)})),
              ElementsAre("Overconfident, where 1 is expected: a (ANEES 5.00) and b (ANEES 5.00). "
                          "F per degree of freedom is 2.0: covariances of the log are too small, "
                          "or loops are false."));
}

}  // namespace
}  // namespace fathom::test
