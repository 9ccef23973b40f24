#include <cmath>
#include <fmt/format.h>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "naive_least_squares.hpp"
#include "world_logs.hpp"

namespace fathom::conformance {
namespace {

void rotated_absolute(Subject& subject) {
  WorldOptions options;
  options.start = uncertain_start({0.5, 1.0, 0.2}, 0.2, 0.03);
  options.pose_every = 11;
  const MeasurementLog log = circle_in_world(options);
  const GuardedEstimator& plain = subject.solved(log, subject.to_the_optimum());
  for (const double turn : {0.3, 2.0, M_PI, -3.1}) {
    const Pose world{7.0, -4.0, turn};
    expect_moved(subject.solved(moved(log, world), subject.to_the_optimum()), plain, world, 1e-8,
                 1e-6);
  }
}

void far_absolute(Subject& subject) {
  WorldOptions options;
  options.start = uncertain_start({0.5, 1.0, 0.2}, 0.2, 0.03);
  options.pose_every = 11;
  const MeasurementLog log = circle_in_world(options);
  expect_moved(subject.solved(moved(log, kFarWorld)), subject.solved(log), kFarWorld, 1e-6, 1e-5);
}

void repeatable_absolute(Subject& subject) {
  WorldOptions options;
  options.start = uncertain_start({}, 0.2, 0.03);
  const MeasurementLog log = circle_in_world(options);
  const GuardedEstimator& a = subject.solved(log);
  const GuardedEstimator& b = subject.solved(log);
  expect_same_bits(b, poses_of(a));
  for (std::size_t k = 0; k < log.size(); ++k) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(b, k),
                      covariance_of(a, k), 0.0);
  }
}

bool has_jump(std::size_t k) {
  return k == 20 || k == 32;
}

// A jump of a fix is a wrong loop to the world.
void gate_refuses_fix(Subject& subject) {
  subject.need("gate_probability");
  WorldOptions options;
  options.position_every = 4;
  const MeasurementLog log = circle_in_world(options);
  GuardedEstimator& estimator = subject.make(log.start(), value("gate_probability", "0.9999"));
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) estimator.add_keyframe(log.arrival(k).step);
    KeyframeMeasurements arrival = log.arrival(k);
    if (has_jump(k)) arrival.absolute.back().pose.x += 20.0;
    const UpdateReport report = estimator.update({arrival.registrations, arrival.absolute});
    for (std::size_t j = 0; j < report.absolute.size(); ++j) {
      const AbsoluteDecision& decision = report.absolute[j];
      const bool is_wrong = has_jump(k) && j + 1 == report.absolute.size();
      const std::string what = fmt::format("absolute measurement {} of keyframe {}{}", j, k,
                                           is_wrong ? ", which jumps," : "");
      const LoopFate expected = is_wrong ? LoopFate::rejected : LoopFate::used;
      expect(decision.fate == expected,
             fmt::format("{} is {}, expected {}", what, name_of(decision.fate), name_of(expected)));
      if (!is_wrong) continue;
      expect(decision.nis.has_value(), what + " has no NIS, and the gate is on");
      expect_at_least("the NIS of " + what + " is", *decision.nis, 100.0);
    }
  }
  expect_poses(estimator, circle(log.size()), 0.5);
}

// Against the full least squares. Filters linearise once a keyframe and are near it.
void least_squares_near(Subject& subject) {
  WorldOptions options;
  options.start = uncertain_start({2.0, -1.0, 3.1}, 0.2, 0.03);
  options.pose_every = 13;
  const MeasurementLog log = circle_in_world(options);
  const NaiveLeastSquares expected = least_squares(log, 10);
  const GuardedEstimator& estimator = subject.solved(log, subject.to_the_optimum());
  expect_poses(estimator, expected.poses, 0.02);
  for (std::size_t k = 0; k < log.size(); ++k) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k),
                      expected.marginal(k), 0.1);
  }
  const std::vector<std::size_t> some{0, 7, 3, 39};
  expect_at_most("the joint covariance, as a share of both keyframes' own, is off by",
                 largest_block_difference(joint_of(estimator, some), expected.joint(some)), 0.1);
}

}  // namespace

std::vector<Clause> world_clauses() {
  return {
      {{"rotated_absolute",
        "turning the world with all that is measured of it turns the estimate alone"},
       rotated_absolute},
      {{"far_absolute",
        "with absolute measurements in coordinates of millions of metres, too, the estimate is "
        "shifted alone"},
       far_absolute},
      {{"repeatable_absolute", "with absolute measurements the same calls give the same bits"},
       repeatable_absolute},
      {{"gate_refuses_fix", "a gate refuses fixes that jump, and no other absolute measurement"},
       gate_refuses_fix},
      {{"least_squares_near",
        "with loops and absolute measurements the estimate is near that of least squares"},
       least_squares_near}};
}

}  // namespace fathom::conformance
