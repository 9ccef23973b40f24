// trajectory_iekf where registrations are told what their pictures share, against a dense textbook
// filter and dense least squares. More of it in shared_filter_test.cpp and beside that.

#include <tuple>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "src/harness/conformance/world_logs.hpp"
#include "tests/estimators/naive_shared_iekf.hpp"
#include "tests/estimators/shared_filter.hpp"

namespace fathom::test {
namespace {

using Form = MotionCovariance::Form;

/// What a picture shares estimated, or considered.
class SharedTrajectoryIekf : public testing::TestWithParam<const char*> {
 protected:
  bool estimates() const { return GetParam() == std::string("states"); }
  // As many linearisations as there may be.
  TrajectoryIekfOptions options(int iterations) const {
    TrajectoryIekfOptions options;
    options.max_iterations = iterations;
    options.tolerance = 1e-300;
    options.shared_errors.model =
        estimates() ? SharedErrorModel::states : SharedErrorModel::consider;
    return options;
  }
};

INSTANTIATE_TEST_SUITE_P(All, SharedTrajectoryIekf, testing::Values("states", "consider"),
                         [](const auto& model) { return std::string(model.param); });

void expect_equal(const TrajectoryIekf& ours, const NaiveSharedIekf& naive, double tolerance) {
  EXPECT_LT(largest_distance(poses_of(ours), naive.poses()), tolerance);
  EXPECT_LT(largest_turn(poses_of(ours), naive.poses()), tolerance);
  const Eigen::MatrixXd expected = naive.covariance();
  EXPECT_LT(largest_block_difference(whole_covariance(ours), expected), tolerance);
  for (std::size_t k = 1; k < ours.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(3 * (k - 1));
    const Eigen::Matrix3d own = expected.block<3, 3>(row, row);
    EXPECT_LT((*ours.covariance(k) - own).norm(), tolerance * own.norm()) << k;
  }
  for (std::size_t k = 0; k < ours.size(); ++k) {
    EXPECT_LT((ours.blocks().pictures().estimate(k) - naive.n(k)).norm(), 10.0 * tolerance) << k;
  }
}

// Full covariances, headings through ±π, loops in both directions and several at once, of which
// some are told nothing; n comes into the state among the motions.
TEST_P(SharedTrajectoryIekf, IsTheTextbookFilterInEveryForm) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SharedWalk walk(30, 4, seed);
    for (const int iterations : {1, 3}) {
      const NaiveSharedIekf naive(walk.log, iterations, estimates());
      for (const Form form : {Form::cheapest, Form::dense, Form::few_loops}) {
        SCOPED_TRACE(testing::Message() << seed << " " << iterations);
        TrajectoryIekf ours({walk.log.start()}, options(iterations), form);
        EXPECT_TRUE(is_done(feed(ours, walk.log)));
        EXPECT_EQ(ours.estimates_shared_errors(), estimates());
        EXPECT_EQ(ours.blocks().size(), 29 + 30);
        expect_equal(ours, naive, 1e-9);
      }
    }
  }
}

// All motions and one update at the end, of loops from every other keyframe or so.
MeasurementLog with_loops_at_its_end(std::uint64_t seed) {
  const SharedWalk walk(20, 9, seed);
  MeasurementLog log;
  for (std::size_t k = 1; k < walk.log.size(); ++k) log.add_keyframe(walk.log.arrival(k).step);
  // A residual written from its other end is another one, to second order.
  for (const RelativePose& z : walk.log.arrival(19).registrations) {
    log.add_registration(z.forward());
  }
  return log;
}

// The steps being the prior, the iterated update is Gauss-Newton on all there is; and who only
// considers n has the same motions of it.
TEST_P(SharedTrajectoryIekf, OneUpdateIteratedToItsEndIsLeastSquares) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const MeasurementLog log = with_loops_at_its_end(seed);
    const NaiveLeastSquares expected = least_squares(log, 30, {}, RegistrationErrors::shared);
    for (const bool safeguard : {false, true}) {
      TrajectoryIekfOptions to_the_end = options(60);
      to_the_end.tolerance = 1e-10;
      to_the_end.safeguard = safeguard;
      TrajectoryIekf ours({}, to_the_end);
      EXPECT_EQ(feed(ours, log), Outcome::converged);
      EXPECT_LT(largest_distance(poses_of(ours), expected.poses), 1e-7) << seed;
      EXPECT_LT(largest_turn(poses_of(ours), expected.poses), 1e-7) << seed;
      // Gauss-Newton's own covariance, at the same place.
      EXPECT_LT(largest_block_difference(whole_covariance(ours), expected.covariance), 1e-6);
    }
    TrajectoryIekf once({}, options(1));
    feed(once, log);
    EXPECT_GT(largest_distance(poses_of(once), expected.poses), 1e-5) << seed;
  }
}

TEST_P(SharedTrajectoryIekf, ConsideredErrorsKeepTheirPrior) {
  const SharedWalk walk(30, 4, 1);
  TrajectoryIekf ours({}, options(3));
  feed(ours, walk.log);
  const Eigen::MatrixXd P = ours.state_covariance().full();
  EXPECT_EQ((P - P.transpose()).norm(), 0.0);
  EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(P).info(), Eigen::Success);
  const std::span<const Eigen::Index> blocks = ours.blocks().pictures().blocks();
  ASSERT_EQ(blocks.size(), 30U);
  for (const Eigen::Index i : blocks) {
    for (const Eigen::Index j : blocks) {
      const Eigen::Matrix3d block = P.block<3, 3>(3 * i, 3 * j);
      const Eigen::Matrix3d prior = (i == j ? 1.0 : 0.0) * Eigen::Matrix3d::Identity();
      if (estimates() && i == j) {
        EXPECT_LT(block.trace(), 3.0);
      } else if (!estimates()) {
        EXPECT_EQ(block, prior);
      }
    }
  }
}

// The gate leaves some registrations of an update and refuses others, told and untold.
TEST_P(SharedTrajectoryIekf, AGatedUpdateIsThatOfTheRegistrationsThatPass) {
  const SharedWalk walk(30, 4, 4);
  TrajectoryIekfOptions with_gate = options(3);
  with_gate.gate.probability = 0.99999;
  with_gate.gate.joint_probability = 0.99999;
  TrajectoryIekf gated({}, with_gate);
  TrajectoryIekf given({}, options(3));
  std::size_t rejected = 0;
  for (std::size_t k = 1; k < walk.log.size(); ++k) {
    std::vector<RelativePose> registrations = walk.log.arrival(k).registrations;
    if (k % 5 == 0) registrations[(k / 5) % registrations.size()].motion.x += 3.0;
    gated.add_keyframe(walk.log.arrival(k).step);
    given.add_keyframe(walk.log.arrival(k).step);
    const UpdateReport report = gated.close_loops(registrations);
    std::vector<RelativePose> passed;
    for (std::size_t j = 0; j < registrations.size(); ++j) {
      if (report.loops[j].fate == LoopFate::used) passed.push_back(registrations[j]);
    }
    rejected += registrations.size() - passed.size();
    given.close_loops(passed);
  }
  EXPECT_EQ(rejected, 5U);
  EXPECT_LT(largest_distance(poses_of(gated), poses_of(given)), 1e-9);
  EXPECT_LT(largest_block_difference(whole_covariance(gated), whole_covariance(given)), 1e-9);
}

RelativePose told_loop(std::size_t from, std::size_t to, const Pose& motion) {
  SharedErrors shared;
  for (PictureErrors* picture : {&shared.from, &shared.to}) {
    picture->G(0, 0) = 0.1;
    picture->sigma.setOnes();
  }
  shared.own.diagonal() << 1e-6, 1e-6, 1e-2;
  RelativePose z = RelativePose::from_covariance(from, to, motion, shared.total());
  z.shared = std::make_shared<const SharedErrors>(shared);
  return z;
}

// A loop asks for half a turn of a long chain: one linearisation leads anywhere.
TEST_P(SharedTrajectoryIekf, AnUpdateThatHasDivergedChangesNothing) {
  for (const Form form : {Form::cheapest, Form::few_loops}) {
    TrajectoryIekf ours({}, options(1), form);
    for (std::size_t k = 1; k <= 12; ++k) {
      ours.add_keyframe(RelativePose::from_covariance(
          k - 1, k, {1.0, 0.0, 0.0}, Eigen::Vector3d(1e-8, 1e-8, 0.09).asDiagonal()));
      if (k != 6) continue;
      const std::vector<RelativePose> loops{told_loop(4, 6, {2.02, 0.0, 0.0}),
                                            told_loop(5, 6, {1.02, 0.0, 0.0})};
      ours.close_loops(loops);
    }
    const std::vector<Pose> poses = poses_of(ours);
    const Eigen::MatrixXd P = whole_covariance(ours);
    const Eigen::Vector3d n = ours.blocks().pictures().estimate(6);
    EXPECT_EQ(n.norm() > 0.1, estimates());
    const RelativePose turned = told_loop(6, 12, {6.0, 0.0, 3.0});
    const UpdateReport report = ours.close_loops(std::span(&turned, 1));
    EXPECT_EQ(report.outcome, Outcome::diverged);
    EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
    EXPECT_EQ(largest_distance(poses_of(ours), poses), 0.0);
    EXPECT_EQ((whole_covariance(ours) - P).norm(), 0.0);
    EXPECT_EQ(ours.blocks().pictures().estimate(6), n);
  }
}

// Absolute measurements and an uncertain start are loops and steps that are told nothing.
TEST_P(SharedTrajectoryIekf, BesideAbsoluteMeasurementsIsLeastSquares) {
  if (!estimates()) return;
  const RedrawnWalk walk(SharedWalk(25, 4, 7), kSmall);
  const MeasurementLog plain = walk.log(drawn_errors(walk.numbers(), 3));
  MeasurementLog log(plain);
  log = MeasurementLog(uncertain_start({}, 0.01 * kSmall, 0.01 * kSmall));
  for (std::size_t k = 1; k < plain.size(); ++k) {
    log.add_keyframe(plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    if (k % 4 == 0) {
      log.add_absolute(AbsolutePose::heading(k, walk.truth()[k].theta, 0.003 * kSmall));
    }
    if (k % 6 == 0) {
      log.add_absolute(AbsolutePose::position(
          k, walk.truth()[k].position(), 1e-4 * kSmall * kSmall * Eigen::Matrix2d::Identity()));
    }
  }
  const auto estimator = solved("trajectory_iekf", log, sharing("states"));
  const NaiveLeastSquares expected = least_squares(log, 10, {}, RegistrationErrors::shared);
  EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-6 * kSmall);
  for (std::size_t k = 0; k < log.size(); ++k) {
    const Eigen::Matrix3d own = expected.marginal(k);
    EXPECT_LT((*estimator->covariance(k) - own).norm(), 1e-5 * own.norm()) << k;
  }
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  for (std::size_t k = 0; k < motions->size(); ++k) {
    const UncertainPose motion = expected.motion_to_newest(k);
    EXPECT_LT(((*motions)[k].covariance - motion.covariance).norm(),
              1e-5 * motion.covariance.norm())
        << k;
  }
}

}  // namespace
}  // namespace fathom::test
