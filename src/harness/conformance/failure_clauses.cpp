#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <utility>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/core/input_error.hpp"
#include "logs.hpp"
#include "naive_least_squares.hpp"

namespace fathom::conformance {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void nan_registration(Subject& subject) {
  const MeasurementLog log = circle_log({});
  const Eigen::Matrix3d C = full_covariance(0.1, 0.1);
  GuardedEstimator& estimator = subject.solved(log);
  estimator.add_keyframe(
      RelativePose::from_covariance(log.size() - 1, log.size(), {1.0, 0.0, 0.0}, C));
  const std::vector<Pose> before = poses_of(estimator);
  const std::vector<RelativePose> bad{
      RelativePose::from_covariance(0, log.size(), {kNaN, 0.0, 0.0}, C)};
  const UpdateReport report = estimator.update({bad});
  expect_outcome("an update with NaN", report.outcome, Outcome::numerical_failure);
  expect(report.loops.front().fate == LoopFate::lost,
         fmt::format("the registration with NaN is {}, expected {}",
                     name_of(report.loops.front().fate), name_of(LoopFate::lost)));
  expect_same_bits(estimator, before);

  // And it is forgotten: the next update is as good as ever.
  const std::vector<RelativePose> good{
      RelativePose::from_covariance(0, log.size(), between(before.front(), before.back()), C)};
  expect_done("the update after one with NaN", estimator.update({good}).outcome);
}

void nan_absolute(Subject& subject) {
  const MeasurementLog log = circle_log({});
  GuardedEstimator& estimator = subject.solved(log);
  const std::vector<Pose> before = poses_of(estimator);
  estimator.add_keyframe(log.arrival(1).step);
  AbsolutePose bad = AbsolutePose::heading(log.size(), 0.3, 0.1);
  bad.pose.theta = kNaN;
  const UpdateReport report = estimator.update({{}, std::span(&bad, 1)});
  expect_outcome("an update with NaN", report.outcome, Outcome::numerical_failure);
  expect(report.absolute.front().fate == LoopFate::lost,
         fmt::format("the measurement with NaN is {}, expected {}",
                     name_of(report.absolute.front().fate), name_of(LoopFate::lost)));
  expect_same_bits(estimator, before);
}

// One loop ever more precise, between two free keyframes or from the fixed one. Beyond what doubles
// carry an update fails; where it does not, the estimate is as good as ever.
void beyond_doubles(Subject& subject) {
  for (const std::size_t from : {std::size_t{0}, std::size_t{7}}) {
    const std::vector<Pose> limit = least_squares(with_precise_loop(from, 1e9), 10).poses;
    Outcome last = Outcome::converged;
    for (int exponent = 10; exponent <= 40; ++exponent) {
      GuardedEstimator& estimator = subject.make();
      last = feed(estimator, with_precise_loop(from, std::pow(10.0, exponent)));
      if (!is_done(last)) continue;
      try {
        expect_poses(estimator, limit, 0.01);
      } catch (const Broken& how) {
        throw Broken(fmt::format("with a loop of information 1e{}, {}", exponent, how.what()));
      }
    }
    expect_outcome("a log with a loop of information 1e40", last, Outcome::numerical_failure);
  }
}

void expect_refused(Subject& subject, const std::string& option, const std::string& given) {
  try {
    subject.make({}, value(option, given));
  } catch (const InputError&) {
    return;
  }
  throw Broken(fmt::format("{} = {} is taken, expected InputError", option, given));
}

void unknown_option(Subject& subject) {
  const std::string unknown = "no_estimator_has_this";
  expect_refused(subject, unknown, "0.9");
}

void option_bounds(Subject& subject) {
  const std::vector<std::pair<std::string, std::string>> bad{{"gate_probability", "1.5"},
                                                             {"max_iterations", "0"}};
  bool has_any = false;
  for (const auto& [option, given] : bad) {
    if (!subject.has(option)) continue;
    has_any = true;
    expect_refused(subject, option, given);
  }
  if (!has_any) throw NotApplicable("no option 'gate_probability' or 'max_iterations'");
}

}  // namespace

std::vector<Clause> failure_clauses() {
  return {{{"nan_registration",
            "a registration with NaN is a numerical failure that leaves the estimate as it was"},
           nan_registration},
          {{"nan_absolute",
            "an absolute measurement with NaN is a numerical failure that leaves it as it was"},
           nan_absolute},
          {{"beyond_doubles",
            "information beyond what doubles carry is a failure, never a wrong estimate"},
           beyond_doubles},
          {{"unknown_option", "an option that it does not have is refused with InputError"},
           unknown_option},
          {{"option_bounds", "option values out of bounds are refused with InputError"},
           option_bounds}};
}

}  // namespace fathom::conformance
