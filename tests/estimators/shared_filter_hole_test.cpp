// Holes that are bridged by registrations which are told what their pictures share.

#include <gtest/gtest.h>

#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/shared_filter.hpp"

namespace fathom::test {
namespace {

class SharedFilterHoles : public SharedFilter {};

INSTANTIATE_TEST_SUITE_P(All, SharedFilterHoles, kEachFilter, name_of);

/// A walk of three stretches, to 7, to 11 and on.
struct Stretches {
  std::string name;
  RedrawnWalk::Keeps keeps;
};

// Loops of a stretch while it hangs in the air bring n into the state before the loop that bridges
// the hole; the loops after it are of the same pictures.
std::vector<Stretches> stretches() {
  return {
      {"one after the other", [](std::size_t, std::size_t) { return true; }},
      {"the second late, by its end",
       [](std::size_t from, std::size_t to) { return to < 8 || to > 10 || from >= 8; }},
      // The last is joined to the first, and then the second to it: the earlier end moves.
      {"the second last",
       [](std::size_t from, std::size_t to) {
         return to < 8 || (to < 12 && from >= 8) || (to == 12 && from < 8) || to > 12;
       }},
  };
}

RedrawnWalk walk_of(const Stretches& stretches) {
  return {SharedWalk(17, 5, 11), kSmall, {8, 12}, stretches.keeps};
}

TEST_P(SharedFilterHoles, OverHolesItsCovarianceIsThatOfItsErrors) {
  for (const Stretches& three : stretches()) {
    SCOPED_TRACE(three.name);
    const RedrawnWalk walk = walk_of(three);
    const auto estimator =
        solved(type(), walk.log(Eigen::VectorXd::Zero(walk.numbers())), options());
    EXPECT_LT(largest_distance(poses_of(*estimator), walk.truth()), 1e-9);
    EXPECT_LT(largest_block_difference(whole_covariance(*estimator),
                                       covariance_of_errors(type(), options(), walk)),
              1e-5);
  }
}

TEST_P(SharedFilterHoles, OverHolesEndsAtTheOptimumIfItEstimates) {
  if (model() != "states") return;
  for (const Stretches& three : stretches()) {
    SCOPED_TRACE(three.name);
    const RedrawnWalk walk = walk_of(three);
    const MeasurementLog log = walk.log(drawn_errors(walk.numbers(), 2));
    ASSERT_EQ(log.hole_count(), 2U);
    const auto estimator = solved(type(), log, options());
    const NaiveLeastSquares expected =
        least_squares(log, 10, walk.truth(), RegistrationErrors::shared);
    EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-5 * kSmall);
    EXPECT_LT(largest_block_difference(whole_covariance(*estimator), expected.covariance), 1e-5);
    const auto motions = estimator->motions_to_newest();
    ASSERT_TRUE(motions);
    for (std::size_t k = 0; k < motions->size(); ++k) {
      const UncertainPose motion = expected.motion_to_newest(k);
      EXPECT_LT(((*motions)[k].covariance - motion.covariance).norm(),
                1e-5 * motion.covariance.norm())
          << k;
    }
  }
}

}  // namespace
}  // namespace fathom::test
