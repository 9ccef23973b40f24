#include <cmath>
#include <fmt/format.h>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "logs.hpp"
#include "naive_least_squares.hpp"

namespace fathom::conformance {
namespace {

void keyframe_zero(Subject& subject) {
  const Pose origin{3.0, -2.0, 2.5};
  GuardedEstimator& estimator = subject.make(origin);
  expect_same_bits(estimator, std::vector<Pose>{origin});
  expect_covariance("covariance(0)", covariance_of(estimator, 0), Eigen::Matrix3d::Zero(), 0.0);
  expect_outcome("finish", estimator.finish({}).outcome, Outcome::converged);
}

void dead_reckoning(Subject& subject) {
  LogOptions options;
  options.loop_every = 0;
  options.origin = {1.0, 2.0, -3.0};
  const MeasurementLog log = circle_log(options);
  GuardedEstimator& estimator = subject.make(options.origin);
  expect_outcome("the log", feed(estimator, log), Outcome::converged);
  expect_poses(estimator, log.odometry(), 1e-12);
  UncertainPose chain{options.origin, Eigen::Matrix3d::Zero()};
  for (std::size_t k = 1; k < log.size(); ++k) {
    chain = compose(chain, {log.arrival(k).step.motion, log.arrival(k).step.covariance()});
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k),
                      chain.covariance, 1e-9);
  }
}

void exact_loop(Subject& subject) {
  LogOptions options;
  options.noise = 0.0;
  const MeasurementLog log = circle_log(options);
  GuardedEstimator& estimator = subject.make();
  expect_outcome("the log", feed(estimator, log), Outcome::converged);
  expect_poses(estimator, circle(options.keyframes), 1e-9);
  options.loop_every = 0;
  const std::size_t last = log.size() - 1;
  const double reckoned = covariance_of(subject.solved(circle_log(options)), last).trace();
  expect_at_most("the last keyframe's variance, of that without loops, is",
                 covariance_of(estimator, last).trace() / reckoned, 0.5);
}

// What is left of exact measurements is rounding, and a cost that rounding makes larger or smaller
// says nothing of an update.
void many_exact_loops(Subject& subject) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 120;
  options.loop_every = 1;
  GuardedEstimator& estimator = subject.make();
  expect_outcome("the log", feed(estimator, circle_log(options)), Outcome::converged);
  expect_poses(estimator, circle(options.keyframes), 1e-9);
}

// A square that comes back, reckoned a little wrong; the loop says: the same place, the same
// heading.
void zero_length_loop(Subject& subject) {
  MeasurementLog log;
  const Eigen::Matrix3d C = full_covariance(0.1, 0.05);
  for (std::size_t k = 1; k <= 4; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.05, 0.0, M_PI / 2 - 0.02}, C));
  }
  log.add_registration(RelativePose::from_covariance(0, 4, {}, 1e-4 * C));
  GuardedEstimator& estimator = subject.make();
  expect_done("the log", feed(estimator, log));
  expect_near("pose 4", estimator.pose(4), {}, 5e-3);
}

void loops_at_once(Subject& subject) {
  const MeasurementLog log = circle_log({});
  GuardedEstimator& estimator = subject.make();
  expect_done("the log", feed(estimator, log));
  const double optimum = chi2(log, least_squares(log, 10).poses);
  const double reached = chi2(log, poses_of(estimator));
  expect_at_most("F, of that of dead reckoning, is", reached / chi2(log, log.odometry()), 0.01);
  expect_at_least("F, of its minimum, is", reached / optimum, 1.0 - 1e-9);
  expect_at_most("F, of its minimum, is", reached / optimum, 1.3);
}

void rotated_world(Subject& subject) {
  LogOptions options;
  const GuardedEstimator& plain = subject.solved(circle_log(options));
  options.origin = {100.0, -50.0, 2.8};
  expect_moved(subject.solved(circle_log(options)), plain, options.origin, 1e-7, 1e-6);
}

// A tolerance that is a share of coordinates, or an error about the origin of the world, is another
// one here. Of coordinates doubles keep a nanometre.
void far_world(Subject& subject) {
  const MeasurementLog log = circle_log({});
  const MeasurementLog far = moved(log, kFarWorld);
  expect_moved(subject.solved(far), subject.solved(log), kFarWorld, 1e-6, 1e-5);
  if (!subject.can_batch()) return;
  expect_moved(subject.solved_in_batch(far, {}), subject.solved_in_batch(log, {}), kFarWorld, 1e-6,
               1e-5);
}

// To and fro over ±π, with loops: the same way at heading 0 never meets it.
void headings_near_pi(Subject& subject) {
  RandomStream random(1, "headings near pi");
  const Eigen::Matrix3d C = full_covariance(0.03, 0.02);
  MeasurementLog log;
  for (std::size_t k = 1; k <= 20; ++k) {
    const Pose step = perturbed({1.0, 0.0, k % 2 == 0 ? 0.04 : -0.04}, 0.03, 0.02, random);
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, step, C));
    if (k % 4 != 0) continue;
    const Pose loop = perturbed({4.0, 0.0, 0.0}, 0.01, 0.01, random);
    log.add_registration(RelativePose::from_covariance(k - 4, k, loop, 0.1 * C));
  }
  const Pose half_turn{0.0, 0.0, M_PI};
  const GuardedEstimator& ahead = subject.solved(log);
  const GuardedEstimator& back = subject.solved(moved(log, half_turn));
  for (std::size_t k = 0; k < log.size(); ++k) {
    const double heading = back.pose(k).theta;
    expect(heading > -M_PI && heading <= M_PI,
           fmt::format("{} has heading {:f} rad, expected above -pi and at most pi",
                       numbered("pose", k), heading));
    expect_near(numbered("pose", k), back.pose(k), compose(half_turn, ahead.pose(k)), 1e-7);
  }
}

void repeatable(Subject& subject) {
  const MeasurementLog log = circle_log({});
  const GuardedEstimator& a = subject.solved(log);
  const GuardedEstimator& b = subject.solved(log);
  expect_same_bits(b, poses_of(a));
  const std::size_t last = log.size() - 1;
  expect_covariance("the last keyframe's covariance", covariance_of(b, last),
                    covariance_of(a, last), 0.0);
}

void empty_update(Subject& subject) {
  GuardedEstimator& estimator = subject.make();
  const Pose step{1.0, 0.0, 0.0};
  estimator.add_keyframe(RelativePose::from_covariance(0, 1, step, full_covariance(0.1, 0.1)));
  expect_outcome("an update without measurements", estimator.update({}).outcome,
                 Outcome::converged);
  expect_same_bits(estimator, std::vector<Pose>{{}, step});
}

}  // namespace

std::vector<Clause> estimate_clauses() {
  return {
      {{"keyframe_zero",
        "an estimator starts with keyframe 0, at the given start and with no covariance"},
       keyframe_zero},
      {{"dead_reckoning", "without loops, poses and covariances are those of the steps composed"},
       dead_reckoning},
      {{"exact_loop", "loops that agree with dead reckoning move nothing and halve the variance"},
       exact_loop},
      {{"many_exact_loops", "a hundred loops without error do not diverge by rounding"},
       many_exact_loops},
      {{"zero_length_loop", "a loop back to the same place and heading is used"}, zero_length_loop},
      {{"loops_at_once", "several loops at once, with full covariances, bring F near its minimum"},
       loops_at_once},
      {{"rotated_world", "a turned and shifted start turns and shifts the estimate alone"},
       rotated_world},
      {{"far_world", "in coordinates of millions of metres the estimate is shifted alone"},
       far_world},
      {{"headings_near_pi",
        "headings are wrapped to (-pi, pi], and an estimate passes there as anywhere"},
       headings_near_pi},
      {{"repeatable", "the same calls give the same estimate, to the last bit"}, repeatable},
      {{"empty_update", "an update without measurements converges and changes nothing"},
       empty_update}};
}

}  // namespace fathom::conformance
