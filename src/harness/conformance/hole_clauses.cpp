#include "clauses.hpp"
#include "expectations.hpp"
#include "naive_least_squares.hpp"
#include "world_logs.hpp"

namespace fathom::conformance {
namespace {

void expect_known(Subject& subject, const MeasurementLog& holed, const std::vector<Pose>& truth) {
  GuardedEstimator& estimator = subject.make(holed.start(), subject.to_the_optimum());
  expect_done("the log", feed(estimator, holed));
  expect_poses(estimator, truth, 0.3);
  const NaiveLeastSquares expected = least_squares(holed, 10, truth);
  for (const std::size_t k : {21, 22, 35, 39}) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k),
                      expected.marginal(k), 0.2);
  }
}

// The loops over the hole come keyframes later, when the part after it has a shape of its own.
void holes_and_loops(Subject& subject) {
  LogOptions options;
  options.loop_every = 4;
  const MeasurementLog log = circle_log(options);
  const std::vector<Pose> truth = circle(options.keyframes);
  for (const Pose& guess : {Pose{}, Pose{-3.0, 2.0, 2.0}, Pose{40.0, -30.0, -3.0}}) {
    for (const bool is_uncertain : {false, true}) {
      MeasurementLog holed = with_holes(log, {22, 30}, guess);
      if (is_uncertain) holed.set_start(uncertain_start({}, 0.01, 0.001));
      expect_known(subject, holed, truth);
    }
  }
}

void holes_and_fixes(Subject& subject) {
  LogOptions plain;
  plain.loop_every = 0;
  WorldOptions options;
  options.position_every = 3;
  const MeasurementLog log = with_holes(circle_in_world(options, plain), {24}, {});
  GuardedEstimator& estimator = subject.make(log.start(), subject.to_the_optimum());
  expect_done("the log", feed(estimator, log));
  expect_poses(estimator, circle(log.size()), 1.0);
}

void holes_in_batch(Subject& subject) {
  subject.need_batch();
  const MeasurementLog log = circle_log({});
  const MeasurementLog holed = with_holes(log, {22, 30}, {5.0, 5.0, 2.0});
  const NaiveLeastSquares expected = least_squares(holed, 20, circle(log.size()));
  const GuardedEstimator& estimator = subject.solved_in_batch(holed, subject.to_the_optimum());
  expect_poses(estimator, expected.poses, 1e-7);
  for (std::size_t k = 0; k < holed.size(); ++k) {
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(estimator, k),
                      expected.marginal(k), 1e-5, 1e-15);
  }
}

// Nothing is known of the start but what a compass and fixes say.
void free_start(Subject& subject) {
  subject.need_batch();
  for (const std::size_t heading_every : {0U, 5U}) {
    WorldOptions options;
    options.heading_every = heading_every;
    options.start = Pose{20.0, -10.0, 2.0};
    MeasurementLog log = circle_in_world(options);
    StartPose start;
    start.is_free = true;
    log.set_start(start);
    const GuardedEstimator& estimator = subject.solved_in_batch(log, subject.to_the_optimum());
    const NaiveLeastSquares expected =
        least_squares(log, 20, circle(log.size(), options.start.pose));
    expect_poses(estimator, expected.poses, 1e-6);
    expect_covariance("covariance(0)", covariance_of(estimator, 0), expected.marginal(0), 1e-4);
    MeasurementLog far = moved(log, kFarWorld);
    far.set_start(start);
    expect_moved(subject.solved_in_batch(far, {}), subject.solved_in_batch(log, {}), kFarWorld,
                 1e-6, 1e-5);
  }
}

}  // namespace

std::vector<Clause> hole_clauses() {
  return {
      {{"holes_and_loops", "loops make a hole in dead reckoning known, whatever the guess over it"},
       holes_and_loops},
      {{"holes_and_fixes", "so do fixes and headings"}, holes_and_fixes},
      {{"holes_in_batch", "in batch mode a hole has no part in the estimate"}, holes_in_batch},
      {{"free_start", "in batch mode a free start is put where absolute measurements say"},
       free_start}};
}

}  // namespace fathom::conformance
