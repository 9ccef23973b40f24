#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "logs.hpp"
#include "naive_least_squares.hpp"

namespace fathom::conformance {
namespace {

// With measurements that agree exactly every linearisation is at the truth, so a filter's
// covariance is that of the least-squares problem, whatever its state: full covariances, rotations,
// loops.
MeasurementLog exact_log(std::size_t keyframes) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = keyframes;
  options.origin = {-4.0, 1.0, 2.0};
  return circle_log(options);
}

// Ends on a loop.
constexpr std::size_t kEndsOnALoop = 26;

// With two that repeat and keyframe 0 among them.
const std::vector<std::size_t>& some_keyframes() {
  static const std::vector<std::size_t> some{13, 0, 4, 19, 13, 5};
  return some;
}

void covariances(Subject& subject) {
  const MeasurementLog log = exact_log(20);
  const GuardedEstimator& estimator = subject.solved(log);
  const NaiveLeastSquares reference = least_squares(log, 1);
  for (std::size_t k = 1; k < log.size(); ++k) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k),
                      reference.marginal(k), 1e-9);
  }
}

void joint_covariance(Subject& subject) {
  const MeasurementLog log = exact_log(20);
  const Eigen::MatrixXd joint = joint_of(subject.solved(log), some_keyframes());
  const Eigen::MatrixXd expected = least_squares(log, 1).joint(some_keyframes());
  expect_at_most("the joint covariance, as a share of both keyframes' own, is off by",
                 largest_block_difference(joint, expected), 1e-9);
}

void joint_symmetry(Subject& subject) {
  const Eigen::MatrixXd joint = joint_of(subject.solved(exact_log(20)), some_keyframes());
  expect_covariance("the transpose of the joint covariance", joint.transpose(), joint, 0.0);
}

void marginals(Subject& subject) {
  const GuardedEstimator& estimator = subject.solved(exact_log(20));
  const Eigen::MatrixXd joint = joint_of(estimator, some_keyframes());
  for (std::size_t i = 0; i < some_keyframes().size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    expect_covariance(numbered("the joint covariance's block of keyframe", some_keyframes()[i]),
                      joint.block<3, 3>(row, row), covariance_of(estimator, some_keyframes()[i]),
                      1e-9);
  }
}

// Exact measurements are linearised at the truth, wherever an estimator linearised last.
void newest_covariance(Subject& subject) {
  const MeasurementLog log = exact_log(20);
  GuardedEstimator& estimator = subject.make(log.origin());
  expect_covariance("newest_covariance() of keyframe 0", newest_covariance_of(estimator),
                    Eigen::Matrix3d::Zero(), 0.0);
  MeasurementLog so_far(log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    so_far.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) so_far.add_registration(z);
    estimator.add_keyframe(log.arrival(k).step);
    if (!log.arrival(k).registrations.empty()) estimator.update({log.arrival(k).registrations});
    expect_covariance(numbered("newest_covariance() of keyframe", k),
                      newest_covariance_of(estimator), least_squares(so_far, 1).marginal(k), 1e-7);
  }
}

void expect_zero(const GuardedEstimator& estimator, const std::vector<std::size_t>& keyframes) {
  const auto size = static_cast<Eigen::Index>(3 * keyframes.size());
  expect_covariance("joint_covariance of keyframe 0", joint_of(estimator, keyframes),
                    Eigen::MatrixXd::Zero(size, size), 0.0);
}

void fixed_covariance(Subject& subject) {
  GuardedEstimator& estimator = subject.make();
  expect_zero(estimator, {0, 0});
  feed(estimator, circle_log({}));
  expect_zero(estimator, {0, 0});
  expect_zero(estimator, {});
}

void motions_to_newest(Subject& subject) {
  const MeasurementLog log = exact_log(kEndsOnALoop);
  const std::vector<UncertainPose> motions = motions_of(subject.solved(log));
  const NaiveLeastSquares reference = least_squares(log, 1);
  for (std::size_t k = 0; k + 1 < log.size(); ++k) {
    const UncertainPose expected = reference.motion_to_newest(k);
    expect_near(numbered("the motion to the newest from keyframe", k), motions[k].mean,
                expected.mean, 1e-9);
    expect_covariance(numbered("covariance of the motion to the newest from keyframe", k),
                      motions[k].covariance, expected.covariance, 0.0, 1e-9);
  }
}

// The other way round, without a reference.
void motions_of_steps(Subject& subject) {
  LogOptions options;
  options.loop_every = 0;
  const MeasurementLog log = circle_log(options);
  const std::vector<UncertainPose> motions = motions_of(subject.solved(log));
  UncertainPose chain;
  for (std::size_t k = log.size() - 1; k-- > 0;) {
    const RelativePose& step = log.arrival(k + 1).step;
    chain = compose(UncertainPose{step.motion, step.covariance()}, chain);
    expect_near(numbered("the motion to the newest from keyframe", k), motions[k].mean, chain.mean,
                1e-11);
    expect_covariance(numbered("covariance of the motion to the newest from keyframe", k),
                      motions[k].covariance, chain.covariance, 1e-9);
  }
}

// Keyframe 0 is fixed at the identity.
void motion_from_zero(Subject& subject) {
  const GuardedEstimator& estimator = subject.solved(circle_log({}));
  const std::size_t newest = estimator.size() - 1;
  const UncertainPose motion = motions_of(estimator).front();
  expect_near("the motion from keyframe 0", motion.mean, estimator.pose(newest), 1e-11);
  expect_covariance("covariance of the motion from keyframe 0", motion.covariance,
                    covariance_of(estimator, newest), 1e-8);
  const std::size_t of_one = motions_of(subject.make()).size();
  expect(of_one == 0, "of keyframe 0 alone there are " + std::to_string(of_one) +
                          " motions to the newest, expected none");
}

void overridden_defaults(Subject& subject) {
  LogOptions options;
  options.keyframes = kEndsOnALoop;
  options.origin = {-4.0, 1.0, 2.0};
  const GuardedEstimator& estimator = subject.solved(circle_log(options));
  const std::vector<UncertainPose> motions = motions_of(estimator);
  const auto expected = estimator.Estimator::motions_to_newest();
  expect(expected.has_value(), "joint_covariance of a keyframe and the newest is nothing");
  for (std::size_t k = 0; k < expected->size(); ++k) {
    expect_near(numbered("the motion to the newest from keyframe", k), motions[k].mean,
                (*expected)[k].mean, 1e-10);
    expect_covariance(numbered("covariance of the motion to the newest from keyframe", k),
                      motions[k].covariance, (*expected)[k].covariance, 1e-8);
    const auto own = estimator.Estimator::covariance(k);
    expect(own.has_value(), numbered("joint_covariance of keyframe", k) + " is nothing");
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k), *own,
                      1e-8);
  }
}

}  // namespace

std::vector<Clause> covariance_clauses() {
  return {
      {{"covariances", "on an exact log, covariances are those of the information matrix"},
       covariances},
      {{"joint_covariance", "so are joint covariances, in the order asked for, with repeats"},
       joint_covariance},
      {{"joint_symmetry", "a joint covariance is symmetric, to the last bit"}, joint_symmetry},
      {{"marginals", "a joint covariance's diagonal blocks are the keyframes' covariances"},
       marginals},
      {{"newest_covariance",
        "on an exact log, newest_covariance() is that of the information matrix at every keyframe"},
       newest_covariance},
      {{"fixed_covariance", "the joint covariance of a fixed keyframe 0, or of none, is zero"},
       fixed_covariance},
      {{"motions_to_newest",
        "on an exact log, motions to the newest are as uncertain as the information matrix says"},
       motions_to_newest},
      {{"motions_of_steps", "without loops, motions to the newest compose the steps between"},
       motions_of_steps},
      {{"motion_from_zero", "the motion from keyframe 0 at the identity is the newest pose"},
       motion_from_zero},
      {{"overridden_defaults",
        "covariance(k) and motions_to_newest() are what follows from joint_covariance()"},
       overridden_defaults}};
}

}  // namespace fathom::conformance
