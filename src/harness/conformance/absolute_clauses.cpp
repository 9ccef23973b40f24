#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "naive_least_squares.hpp"
#include "world_logs.hpp"

namespace fathom::conformance {
namespace {

void uncertain_zero(Subject& subject) {
  const StartPose start = uncertain_start({3.0, -2.0, 2.5}, 0.4, 0.1);
  const GuardedEstimator& estimator = subject.make(start);
  expect_poses(estimator, std::vector<Pose>{start.pose}, 1e-14);
  expect_covariance("covariance(0)", covariance_of(estimator, 0), start.covariance, 0.0, 1e-12);
}

// A turn of the whole map about keyframe 0, and a shift. The log is exact: a filter on poses that
// linearises elsewhere learns from loops what they do not say of the map's heading
// (docs/absolute_measurements.md).
void uncertain_map(Subject& subject) {
  LogOptions options;
  options.origin = {1.0, 2.0, -3.0};
  options.noise = 0.0;
  const MeasurementLog plain = circle_log(options);
  MeasurementLog log = plain;
  log.set_start(uncertain_start(plain.origin(), 0.3, 0.05));
  const GuardedEstimator& fixed = subject.solved(plain, subject.to_the_optimum());
  const GuardedEstimator& free = subject.solved(log, subject.to_the_optimum());
  expect_poses(free, poses_of(fixed), 1e-9);
  for (std::size_t k = 0; k < log.size(); ++k) {
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    const Eigen::Vector2d lever = fixed.pose(k).position() - fixed.pose(0).position();
    J.topRightCorner<2, 1>() << -lever.y(), lever.x();
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(free, k),
                      covariance_of(fixed, k) + transport(J, log.start().covariance), 1e-7);
  }
}

void exact_absolute(Subject& subject) {
  LogOptions plain;
  plain.noise = 0.0;
  WorldOptions options;
  options.noise = 0.0;
  options.pose_every = 9;
  options.start = uncertain_start({5.0, 1.0, 3.0}, 0.2, 0.05);
  const MeasurementLog log = circle_in_world(options, plain);
  GuardedEstimator& estimator = subject.make(log.start(), subject.to_the_optimum());
  expect_outcome("the log", feed(estimator, log), Outcome::converged);
  expect_poses(estimator, circle(plain.keyframes, log.origin()), 1e-9);
  expect_at_most("keyframe 0's variance, of that of the start, is",
                 covariance_of(estimator, 0).trace() / log.start().covariance.trace(), 0.9);
}

// Zero information is no measurement.
void without_information(Subject& subject) {
  const MeasurementLog plain = circle_log({});
  MeasurementLog log;
  for (std::size_t k = 1; k < plain.size(); ++k) {
    log.add_keyframe(plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    // An update of its own would have its own iterations.
    if (!plain.arrival(k).registrations.empty()) log.add_absolute({k, {100.0, -50.0, 1.0}});
  }
  const GuardedEstimator& with = subject.solved(log);
  const GuardedEstimator& without = subject.solved(plain);
  expect_same_bits(with, poses_of(without));
  for (std::size_t k = 0; k < log.size(); ++k) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(with, k),
                      covariance_of(without, k), 0.0);
  }
}

// Headings known to 1e-7 rad and measured without error: what is left is linear in the positions.
MeasurementLog linear_log() {
  RandomStream random(3, "linear");
  StartPose start({1.0, 2.0, 0.7});
  start.covariance = Eigen::Vector3d(0.04, 0.09, 1e-14).asDiagonal();
  MeasurementLog log(start);
  const Eigen::Matrix3d step = Eigen::Vector3d(0.01, 0.02, 1e-14).asDiagonal();
  const Eigen::Matrix3d loop = Eigen::Vector3d(0.003, 0.001, 1e-14).asDiagonal();
  const auto noisy = [&](double x, double y, double sigma) {
    return Pose{x + sigma * random.normal(), y + sigma * random.normal(), 0.0};
  };
  for (std::size_t k = 1; k < 12; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, noisy(1.0, 0.2, 0.1), step));
    if (k % 4 == 0) {
      log.add_registration(RelativePose::from_covariance(k - 4, k, noisy(4.0, 0.8, 0.05), loop));
    }
    if (k % 3 == 0) {
      const auto steps = static_cast<double>(k);
      const Eigen::Vector2d at = transform(log.origin(), {steps, 0.2 * steps});
      const Pose error = noisy(0.0, 0.0, 0.3);
      log.add_absolute(AbsolutePose::position(k, at + error.position(), fix_covariance(0.3)));
    }
    if (k % 5 == 0) log.add_absolute(AbsolutePose::heading(k, 0.7, 1e-7));
  }
  return log;
}

void linear_case(Subject& subject) {
  const MeasurementLog log = linear_log();
  const NaiveLeastSquares expected = least_squares(log, 6);
  const GuardedEstimator& estimator = subject.solved(log, subject.to_the_optimum("1e-18"));
  expect_poses(estimator, expected.poses, 1e-9);
  for (std::size_t k = 0; k < log.size(); ++k) {
    expect_covariance(numbered("covariance of the position of keyframe", k),
                      covariance_of(estimator, k).topLeftCorner<2, 2>(),
                      expected.marginal(k).topLeftCorner<2, 2>(), 1e-9);
  }
}

void nanometre_fixes(Subject& subject) {
  WorldOptions options;
  options.position_sigma_m = 1e-9;
  options.heading_sigma_rad = 1e-9;
  options.noise = 0.0;
  options.position_every = 1;
  options.start = uncertain_start({}, 1.0, 0.5);
  const std::vector<Pose> truth = circle(LogOptions{}.keyframes);
  const MeasurementLog log = in_world(circle_log({}), truth, options);
  GuardedEstimator& estimator = subject.make(options.start);
  expect_done("the log", feed(estimator, log));
  expect_poses(estimator, truth, 1e-8);
}

}  // namespace

std::vector<Clause> absolute_clauses() {
  return {
      {{"uncertain_zero", "keyframe 0 starts with the covariance of the start"}, uncertain_zero},
      {{"uncertain_map",
        "without absolute measurements a start's uncertainty moves nothing and carries over to "
        "every keyframe"},
       uncertain_map},
      {{"exact_absolute", "exact headings, fixes and poses move nothing and sharpen keyframe 0"},
       exact_absolute},
      {{"without_information",
        "absolute measurements without information change nothing, to the last bit"},
       without_information},
      {{"linear_case", "where the problem is linear, the estimate is that of least squares"},
       linear_case},
      {{"nanometre_fixes", "a prior of a nanometre on every keyframe puts the estimate on it"},
       nanometre_fixes}};
}

}  // namespace fathom::conformance
