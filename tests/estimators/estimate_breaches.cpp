// What breaks the clauses on poses, failures and loops.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "tests/estimators/breaches.hpp"

namespace fathom::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void drop(std::vector<RelativePose>& registrations) {
  registrations.clear();
}

void call_it_done(UpdateReport& report) {
  report.outcome = Outcome::converged;
  for (LoopDecision& loop : report.loops) loop.fate = LoopFate::used;
  for (AbsoluteDecision& decision : report.absolute) decision.fate = LoopFate::used;
}

// z for ⊖z.
void mistake_the_direction(std::vector<RelativePose>& registrations) {
  for (RelativePose& z : registrations) {
    if (z.from > z.to) std::swap(z.from, z.to);
  }
}

}  // namespace

std::vector<Breach> estimate_breaches() {
  return {
      {"keyframe_zero",
       "pose 0 is off by 3.61 m, at most 0 allowed",
       {.setup = [](auto& setup, auto&) { setup.start.pose = Pose{}; }}},
      {"dead_reckoning", "pose 1 is off by", {.step = [](auto& step) { step.motion.x *= 1.001; }}},
      {"dead_reckoning",
       "covariance of keyframe 1 is off by",
       {.covariance = times<Eigen::Matrix3d>(1.01)}},
      {"dead_reckoning",
       "add_keyframe at keyframe 1 threw an exception: no licence",
       {.step = [](auto&) { throw std::runtime_error("no licence"); }}},
      {"dead_reckoning", "pose 0 is not finite", {.pose = [](auto& pose) { pose.y = kNaN; }}},
      {"dead_reckoning", "size() is 2, expected 1", {.size = [](auto& size) { ++size; }}},
      {"dead_reckoning",
       "covariance(1) is nothing",
       {.covariance = [](auto& covariance) { covariance.reset(); }}},
      {"exact_loop",
       "the last keyframe's variance, of that without loops, is 1, at most 0.5",
       {.registrations = drop}},
      {"many_exact_loops",
       "ended as iteration_limit, expected converged",
       {.report = [](auto& report) { report.outcome = Outcome::iteration_limit; }}},
      {"zero_length_loop",
       "pose 4 is off by",
       {.registrations =
            [](auto& all) {
              if (all.front().motion.position().norm() < 1e-3) all.clear();
            }}},
      {"loops_at_once",
       "F, of that of dead reckoning, is",
       {.registrations = [](auto& all) { all.resize(1); }}},
      {"loops_at_once",
       "has 0 decisions on registrations, expected 2",
       {.report = [](auto& report) { report.loops.clear(); }}},
      {"rotated_world",
       "pose 0 is off by 2.8 rad, at most 1e-07 allowed",
       {.setup = [](auto& setup, auto&) { setup.start.pose.theta = 0.0; }}},
      {"far_world",
       "pose 0 is off by",
       {.pose = [](auto& pose) { pose.y = static_cast<float>(pose.y); }}},
      {"headings_near_pi",
       "expected above -pi and at most pi",
       {.pose =
            [](auto& pose) {
              if (pose.theta < 0.0) pose.theta += 2.0 * M_PI;
            }}},
      {"repeatable", "at most 0 allowed", {.pose = drift}},
      {"empty_update",
       "an update without measurements ended as iteration_limit",
       {.report = [](auto& report) { report.outcome = Outcome::iteration_limit; }}}};
}

std::vector<Breach> failure_breaches() {
  return {{"nan_registration",
           "an update with NaN ended as converged, expected numerical_failure",
           {.report = call_it_done}},
          {"nan_absolute",
           "an update with NaN ended as converged, expected numerical_failure",
           {.report = call_it_done}},
          {"beyond_doubles",
           "information 1e40 ended as converged, expected numerical_failure",
           {.registrations =
                [](auto& all) {
                  for (RelativePose& z : all)
                    z.information /= std::max(1.0, z.information(0, 0) / 1e6);
                }}},
          {"beyond_doubles",
           "with a loop of information 1e10, pose",
           {.pose = [](auto& pose) { pose.x += 0.02; }}},
          {"unknown_option",
           "no_estimator_has_this = 0.9 is taken, expected InputError",
           {.setup = [](auto&, auto& values) { values.clear(); }}},
          {"option_bounds",
           "gate_probability = 1.5 is taken, expected InputError",
           {.setup = ignore_the_gate}}};
}

std::vector<Breach> loop_breaches() {
  return {{"either_direction", "is off by", {.registrations = mistake_the_direction}},
          {"either_direction_with_loss",
           "with loss = huber, pose",
           {.registrations = mistake_the_direction}},
          {"false_loops_with_loss",
           "has 0 and 0 weights",
           {.weights = [](auto& weights, const auto&) { weights.clear(); }}},
          {"false_loops_with_loss",
           "the weight of registration 1 changes by",
           {.weights =
                [](auto& weights, const auto& given) {
                  for (std::size_t j = 0; j < given.size(); ++j) {
                    if (given[j].from > given[j].to) weights[j] *= 0.5;
                  }
                }}},
          {"gate_refuses", "the wrong loop from 10 to 40 is used", {.report = call_it_done}},
          {"gate_refuses", "the right loop from 0 to 20 has no NIS", {.setup = ignore_the_gate}},
          {"gate_share", "of 40, number 40, at most 30 allowed", {.setup = ignore_the_gate}}};
}

}  // namespace fathom::test
