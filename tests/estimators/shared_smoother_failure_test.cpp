// The errors that pictures share in incremental_smoother, where updates fail, a loss is on, or a
// gate judges.

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/measurements/shared_log.hpp"

namespace fathom {
namespace {

using test::arrive;
using test::SharedWalk;

RelativePose told(const MeasurementLog& log, std::size_t from, std::size_t to, const Pose& motion) {
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      if (!z.shared) continue;
      RelativePose other = z;
      other.from = from;
      other.to = to;
      other.motion = motion;
      return other;
    }
  }
  throw InputError("nothing is told");
}

// Of pictures that had none, one and more registrations; the last of them cannot be solved.
std::vector<RelativePose> bad_loops(const MeasurementLog& log, std::size_t k) {
  const auto right = [&](std::size_t from) {
    return told(log, from, k, between(log.odometry()[from], log.odometry()[k]));
  };
  return {right(0), right(k - 2), right(k / 2), told(log, k - 1, k, {1e200, 0.0, 0.0})};
}

TEST(SharedSmoother, AnUpdateThatFailsIsForgotten) {
  for (const char* gate : {"off", "0.999999999"}) {
    EstimatorValues values = test::exactly();
    const MeasurementLog log = SharedWalk(60, 1, 9).log;
    values["gate_probability"] = OptionValue::scalar(gate);
    const auto disturbed = test::make("incremental_smoother", log.start(), values);
    const auto undisturbed = test::make("incremental_smoother", log.start(), values);
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*disturbed, log, k);
      arrive(*undisturbed, log, k);
      if (k < 9 || k % 5 != 0) continue;
      const std::vector<Pose> before = poses_of(*disturbed);
      const UpdateReport report = disturbed->update({bad_loops(log, k)});
      ASSERT_EQ(report.outcome, Outcome::numerical_failure);
      EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
      EXPECT_EQ(poses_of(*disturbed), before);
      const Eigen::Matrix3d C = *undisturbed->covariance(k);
      EXPECT_LT((*disturbed->covariance(k) - C).norm(), 1e-6 * C.norm()) << k;
    }
    EXPECT_LT(test::largest_distance(poses_of(*disturbed), poses_of(*undisturbed)), 1e-6);
  }
}

TEST(SharedSmoother, StopsAtItsLimitAndGoesOnWithTheNextUpdate) {
  const MeasurementLog log = SharedWalk(60, 3, 5).log;
  const auto hasty = test::solved("incremental_smoother", log,
                                  test::values({{"max_iterations", "1"}, {"tolerance", "1e-12"}}));
  const auto whole = test::solved("sparse_gauss_newton", log);
  EXPECT_LT(shared_chi2(log, poses_of(*hasty)), 1.1 * shared_chi2(log, poses_of(*whole)));
}

// The loss is on what is a registration's own.
TEST(SharedSmoother, HasTheOptimumOfTheWholeGraphWithALoss) {
  const MeasurementLog log = SharedWalk(80, 3, 21).log;
  for (const char* loss : {"huber", "cauchy"}) {
    const auto ours = test::make("incremental_smoother", log.start(), test::exactly_with(loss));
    const auto whole = test::make("sparse_gauss_newton", log.start(), test::exactly_with(loss));
    for (std::size_t k = 1; k < log.size(); ++k) {
      ASSERT_EQ(arrive(*ours, log, k).outcome, Outcome::converged) << loss << k;
      arrive(*whole, log, k);
      ASSERT_LT(test::largest_distance(poses_of(*ours), poses_of(*whole)), 1e-5) << loss << k;
    }
    const Eigen::Matrix3d C = *whole->covariance(log.size() - 1);
    EXPECT_LT((*ours->covariance(log.size() - 1) - C).norm(), 1e-4 * C.norm());
    const std::vector<double> weights = whole->loop_weights();
    const std::vector<double> ours_weights = ours->loop_weights();
    ASSERT_EQ(ours_weights.size(), weights.size());
    EXPECT_LT(*std::ranges::min_element(weights), 0.9);
    for (std::size_t j = 0; j < weights.size(); ++j) EXPECT_NEAR(ours_weights[j], weights[j], 1e-3);
  }
}

double least_cost(const MeasurementLog& log) {
  return shared_chi2(log,
                     conformance::least_squares(log, 30, {}, RegistrationErrors::shared).poses);
}

// Of each new loop the NIS is what F, minimised over poses and errors, rises by for it alone, to
// first order; and that of the whole graph. Some keyframes arrive behind others that the tree does
// not have yet; of one registration a keyframe, all pictures are folded that a loop comes to.
void expect_nis(int per_keyframe) {
  const MeasurementLog log = SharedWalk(17, per_keyframe, 3).log;
  EstimatorValues values = test::exactly();
  values["gate_probability"] = OptionValue::scalar("0.999999999");
  const auto whole = test::make("sparse_gauss_newton", log.start(), values);
  // A tree that is linearised at the estimate.
  for (const char* limit : {"relinearise_m", "relinearise_rad"}) {
    values[limit] = OptionValue::scalar("1e-12");
  }
  const auto estimator = test::make("incremental_smoother", log.start(), values);
  MeasurementLog so_far(log.start());
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    so_far.add_keyframe(arrival.step);
    estimator->add_keyframe(arrival.step);
    whole->add_keyframe(arrival.step);
    if (k % 3 == 1) continue;
    // Twice: of the second time the pictures may be folded into one and the same edge.
    for (int time = 0; time < 2; ++time) {
      const UpdateReport report = estimator->update({arrival.registrations});
      const UpdateReport expected = whole->update({arrival.registrations});
      const double F = least_cost(so_far);
      for (std::size_t j = 0; j < report.loops.size(); ++j) {
        MeasurementLog with = so_far;
        with.add_registration(arrival.registrations[j]);
        const double rise = least_cost(with) - F;
        EXPECT_NEAR(*report.loops[j].nis, rise, 0.15 * rise + 1e-2) << k;
        const double nis = *expected.loops[j].nis;
        EXPECT_NEAR(*report.loops[j].nis, nis, 1e-4 * nis + 1e-6) << k;
      }
      for (const RelativePose& z : arrival.registrations) so_far.add_registration(z);
    }
  }
}

TEST(SharedSmoother, GatesTestWhatIsLeftOfTheSharedErrors) {
  for (const int per_keyframe : {1, 2, 4}) expect_nis(per_keyframe);
}

// After a loop that the sums of the tree do not carry there is none, and the graph is asked.
void expect_nis_without_tree(int per_keyframe) {
  const MeasurementLog log = SharedWalk(17, per_keyframe, 3).log;
  EstimatorValues values = test::exactly();
  values["gate_probability"] = OptionValue::scalar("0.999999999");
  const auto ours = test::make("incremental_smoother", log.start(), values);
  const auto whole = test::make("sparse_gauss_newton", log.start(), values);
  std::size_t judged = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    std::vector<RelativePose> registrations = log.arrival(k).registrations;
    if (k == 4) {
      const Pose motion = between(ours->pose(1), ours->pose(3));
      registrations = {{1, 4, compose(motion, log.arrival(4).step.forward().motion),
                        1e20 * Eigen::Matrix3d::Identity(), std::nullopt}};
    }
    ours->add_keyframe(log.arrival(k).step);
    whole->add_keyframe(log.arrival(k).step);
    if (k % 3 == 2) continue;
    const UpdateReport report = ours->update({registrations});
    const UpdateReport expected = whole->update({registrations});
    ASSERT_EQ(report.outcome, Outcome::converged) << k;
    for (std::size_t j = 0; j < report.loops.size(); ++j) {
      const double nis = *expected.loops[j].nis;
      EXPECT_NEAR(*report.loops[j].nis, nis, 1e-4 * nis + 1e-6) << k;
      judged += k > 4 ? 1 : 0;
    }
  }
  EXPECT_GT(judged, 0u);
}

TEST(SharedSmoother, GatesTestWithoutATree) {
  for (const int per_keyframe : {1, 2, 4}) expect_nis_without_tree(per_keyframe);
}

}  // namespace
}  // namespace fathom
