#include <cmath>
#include <fmt/format.h>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "logs.hpp"

namespace fathom::conformance {
namespace {

bool every(std::size_t /*index*/) {
  return true;
}

bool every_other(std::size_t index) {
  return index % 2 == 1;
}

// All of them, and single ones of a set.
void expect_no_difference(Subject& subject, const EstimatorValues& values) {
  LogOptions options;
  options.noise = 0.01;
  const MeasurementLog log = circle_log(options);
  const std::vector<Pose> poses = poses_of(subject.solved(log, values));
  // Second order in a noise of 3e-4 m and 2e-4 rad.
  expect_poses(subject.solved(rewritten(log, every), values), poses, 1e-6);
  expect_poses(subject.solved(rewritten(log, every_other), values), poses, 1e-6);
}

void either_direction(Subject& subject) {
  expect_no_difference(subject, {});
}

void either_direction_with_loss(Subject& subject) {
  subject.need("loss");
  for (const std::string& loss : subject.losses()) {
    try {
      expect_no_difference(subject, value("loss", loss));
    } catch (const Broken& how) {
      throw Broken(fmt::format("with loss = {}, {}", loss, how.what()));
    }
  }
}

// They bear each other out, in one set and in the next, either direction among them.
void false_loops_with_loss(Subject& subject) {
  subject.need("loss");
  const MeasurementLog log = with_a_false_place(60);
  const MeasurementLog mixed = rewritten(log, every_other);
  for (const std::string& loss : subject.losses()) {
    // huber follows them, and what is far off is not the same the other way round to first order.
    if (loss == "huber") continue;
    const std::vector<double> straight = subject.solved(log, value("loss", loss)).loop_weights();
    const std::vector<double> turned = subject.solved(mixed, value("loss", loss)).loop_weights();
    expect(turned.size() == straight.size() && straight.size() == log.registration_count(),
           fmt::format("with loss = {}, loop_weights() has {} and {} weights, expected {}", loss,
                       straight.size(), turned.size(), log.registration_count()));
    for (std::size_t j = 0; j < turned.size(); ++j) {
      expect_at_most(
          fmt::format("with loss = {}, the weight of registration {} changes by", loss, j),
          std::abs(turned[j] - straight[j]), 0.05);
    }
  }
}

void gate_refuses(Subject& subject) {
  subject.need("gate_probability");
  MeasurementLog log = circle_log({});
  const std::size_t k = log.size();
  const RelativePose last = log.arrival(k - 1).step;
  log.add_keyframe(RelativePose::from_covariance(k - 1, k, last.motion, last.covariance()));
  const std::vector<Pose> without = poses_of(subject.solved(log));
  const Pose right = between(without[10], without[k]);
  log.add_registration(RelativePose::from_covariance(
      10, k, {right.x + 5.0, right.y - 3.0, wrap_angle(right.theta + 1.0)},
      full_covariance(0.01, 0.005)));

  GuardedEstimator& gated = subject.make({}, value("gate_probability", "0.9999"));
  std::vector<LoopDecision> decisions;
  expect_done("the log", feed(gated, log, &decisions));
  for (const LoopDecision& decision : decisions) {
    const std::string loop =
        fmt::format("the {} loop from {} to {}", decision.to == k ? "wrong" : "right",
                    decision.from, decision.to);
    expect((decision.fate == LoopFate::used) == (decision.to != k),
           loop + " is " + name_of(decision.fate));
    expect(decision.nis.has_value(), loop + " has no NIS, and the gate is on");
  }
  expect_at_least("the NIS of the wrong loop is", *decisions.back().nis, 100.0);
  expect_poses(gated, without, 1e-9);

  // Without the gate the same loop is taken, and ruins the estimate.
  expect_at_least("the wrong loop, without a gate, moves the estimate by",
                  largest_distance(poses_of(subject.solved(log)), without), 0.5, "m");
}

// One loop, over a short way: the innovation is as Gaussian as its noise.
MeasurementLog short_way(std::uint64_t seed) {
  RandomStream random(seed, "gate");
  const Pose step{1.0, 0.0, 0.3};
  const Eigen::Matrix3d C = Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal();
  MeasurementLog log;
  Pose truth;
  for (std::size_t k = 1; k <= 5; ++k) {
    log.add_keyframe(
        RelativePose::from_covariance(k - 1, k, perturbed(step, 0.01, 0.005, random), C));
    truth = compose(truth, step);
  }
  log.add_registration(
      RelativePose::from_covariance(0, 5, perturbed(truth, 0.01, 0.005, random), C));
  return log;
}

void gate_share(Subject& subject) {
  subject.need("gate_probability");
  double accepted = 0.0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    GuardedEstimator& estimator = subject.make({}, value("gate_probability", "0.5"));
    std::vector<LoopDecision> decisions;
    feed(estimator, short_way(seed), &decisions);
    if (decisions.front().fate == LoopFate::used) ++accepted;
  }
  // Binomial(40, 0.5): outside 10 … 30 once in a thousand.
  const std::string what = "right loops that a gate at 0.5 lets through, of 40, number";
  expect_at_least(what, accepted, 10.0);
  expect_at_most(what, accepted, 30.0);
}

}  // namespace

std::vector<Clause> loop_clauses() {
  return {
      {{"either_direction", "a loop written the other way round is the same to first order"},
       either_direction},
      {{"either_direction_with_loss", "the same with each robust loss"},
       either_direction_with_loss},
      {{"false_loops_with_loss",
        "a redescending loss weighs false loops alike whichever way round they are written"},
       false_loops_with_loss},
      {{"gate_refuses", "a gate refuses a wrong loop, keeps the right ones, and gives their NIS"},
       gate_refuses},
      {{"gate_share", "a gate lets through the share of right loops that it is set to"},
       gate_share}};
}

}  // namespace fathom::conformance
