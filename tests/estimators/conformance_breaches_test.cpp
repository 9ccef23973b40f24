// Estimators that are right but for one thing: every clause of the contract finds one of them out.

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/harness/conformance.hpp"
#include "src/harness/conformance/logs.hpp"
#include "tests/estimators/spoilt_estimator.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// It has a batch mode, losses and a gate, so that every clause applies.
const EstimatorEntry& good() {
  return builtin_estimators().find("sparse_gauss_newton");
}

struct Breach {
  std::string clause;
  std::string how;  ///< a part of what is said
  Spoils spoils;
};

// What is spoilt, for several rows.

void drop(std::vector<RelativePose>& registrations) {
  registrations.clear();
}

void drop_absolute(std::vector<AbsolutePose>& absolute) {
  absolute.clear();
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

void ignore_the_gate(EstimatorSetup& /*setup*/, EstimatorValues& values) {
  values.erase("gate_probability");
}

void hold_the_start(EstimatorSetup& setup, EstimatorValues& /*values*/) {
  setup.start = setup.start.pose;
}

void measure_the_hole(RelativePose& step) {
  if (!step.is_hole) return;
  step.is_hole = false;
  step.information = 1e4 * Eigen::Matrix3d::Identity();
}

void measure_a_jump(RelativePose& step) {
  if (step.is_hole) step.motion.x += 100.0;
  measure_the_hole(step);
}

// Another number every time.
void drift(Pose& pose) {
  static double noise = 0.0;
  pose.x += noise += 1e-15;
}

template <class Matrix>
std::function<void(std::optional<Matrix>&)> times(double factor) {
  return [factor](std::optional<Matrix>& covariance) { *covariance *= factor; };
}

void widen(std::vector<UncertainPose>& motions) {
  for (UncertainPose& motion : motions) motion.covariance *= 1.001;
}

void forget_correlations(std::optional<Eigen::MatrixXd>& joint) {
  for (Eigen::Index i = 0; i < joint->rows(); i += 3) {
    for (Eigen::Index j = 0; j < joint->cols(); j += 3) {
      if (i != j) joint->block<3, 3>(i, j).setZero();
    }
  }
}

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

std::vector<Breach> covariance_breaches() {
  return {{"covariances",
           "covariance of keyframe 1 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}},
          {"joint_covariance",
           "the joint covariance, as a share of both keyframes' own, is off by",
           {.joint = forget_correlations}},
          {"joint_symmetry",
           "the transpose of the joint covariance is off by",
           {.joint = [](auto& joint) { (*joint)(0, 1) *= 1.0 + 1e-12; }}},
          {"marginals",
           "the joint covariance's block of keyframe 13 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}},
          {"newest_covariance",
           "newest_covariance() of keyframe 1 is off by",
           {.newest_covariance = times<Eigen::Matrix3d>(1.001)}},
          {"fixed_covariance",
           "joint_covariance of keyframe 0 is off by",
           {.joint = [](auto& joint) { joint->diagonal().array() += 1e-9; }}},
          {"motions_to_newest",
           "covariance of the motion to the newest from keyframe 0 is off by",
           {.motions = widen}},
          {"motions_of_steps",
           "the motion to the newest from keyframe 38 is off by",
           {.motions =
                [](auto& motions) {
                  for (UncertainPose& motion : motions) motion.mean = inverse(motion.mean);
                }}},
          {"motion_from_zero",
           "covariance of the motion from keyframe 0 is off by",
           {.motions = widen}},
          {"overridden_defaults",
           "covariance of the motion to the newest from keyframe 0 is off by",
           {.motions = widen}},
          {"overridden_defaults",
           "covariance of keyframe 1 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}}};
}

std::vector<Breach> absolute_breaches() {
  return {{"uncertain_zero", "covariance(0) is off by", {.setup = hold_the_start}},
          {"uncertain_map", "covariance of keyframe 0 is off by", {.setup = hold_the_start}},
          {"exact_absolute",
           "keyframe 0's variance, of that of the start, is",
           {.absolute = drop_absolute}},
          {"without_information",
           "at most 0 allowed",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) z.information += 1e-3 * Eigen::Matrix3d::Identity();
                }}},
          {"linear_case",
           "is off by",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) z.information *= 1.1;
                }}},
          {"nanometre_fixes", "is off by", {.absolute = drop_absolute}},
          {"rotated_absolute",
           "is off by",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) {
                    z.information = transport(planar_rotation(z.pose.theta), z.information);
                  }
                }}},
          {"repeatable_absolute", "at most 0 allowed", {.pose = drift}},
          {"gate_refuses_fix",
           "of keyframe 20, which jumps, is used, expected rejected",
           {.setup = ignore_the_gate}},
          {"least_squares_near", "is off by", {.absolute = drop_absolute}},
          {"holes_and_loops", "is off by", {.step = measure_the_hole}},
          {"holes_and_fixes", "is off by", {.step = measure_a_jump}},
          {"holes_in_batch", "is off by", {.step = measure_the_hole}},
          {"free_start", "is off by", {.setup = hold_the_start}}};
}

const std::vector<Breach>& breaches() {
  static const std::vector<Breach> all = [] {
    std::vector<Breach> joined;
    for (const auto part : {estimate_breaches, failure_breaches, loop_breaches, covariance_breaches,
                            absolute_breaches}) {
      for (Breach& breach : part()) joined.push_back(std::move(breach));
    }
    return joined;
  }();
  return all;
}

TEST(ConformanceBreaches, EachIsFoundByItsClause) {
  for (const auto& [clause, how, spoils] : breaches()) {
    const ConformanceVerdict verdict = conformance_of(spoilt(good(), spoils), clause);
    EXPECT_EQ(verdict.conformity, Conformity::broken) << clause << ", " << how;
    EXPECT_THAT(verdict.how, HasSubstr(how)) << clause;
  }
}

TEST(ConformanceBreaches, EveryClauseHasOneAndIsKeptByTheEstimatorUnspoilt) {
  std::set<std::string> seen;
  for (const Breach& breach : breaches()) seen.insert(breach.clause);
  std::set<std::string> names;
  for (const ConformanceClause& clause : conformance_clauses()) {
    EXPECT_TRUE(names.insert(clause.name).second) << clause.name << ": two have this name";
    EXPECT_FALSE(clause.rule.empty()) << clause.name;
    const ConformanceVerdict verdict = conformance_of(spoilt(good(), {}), clause.name);
    EXPECT_EQ(verdict.conformity, Conformity::kept) << clause.name << ": " << verdict.how;
  }
  EXPECT_EQ(seen, names);
}

TEST(ConformanceBreaches, AFactoryThatFailsBreaksEveryClauseThatApplies) {
  EstimatorEntry nothing = good();
  nothing.create = [](const auto&, const auto&) { return std::unique_ptr<Estimator>(); };
  EstimatorEntry refusing = good();
  refusing.create = [](const auto&, const auto&) -> std::unique_ptr<Estimator> { throw 7; };
  for (const ConformanceClause& clause : conformance_clauses()) {
    EXPECT_THAT(conformance_of(nothing, clause.name).how, HasSubstr("returned no estimator"));
    EXPECT_THAT(conformance_of(refusing, clause.name).how, HasSubstr("is no std::exception"));
  }
}

TEST(ConformanceBreaches, AClauseOnWhatAnEstimatorLacksDoesNotApply) {
  EstimatorEntry plain = good();
  plain.can_batch = false;
  plain.options.clear();
  plain.create = [](const EstimatorSetup& setup, const EstimatorValues& values) {
    return good().create(setup, values);
  };
  std::set<std::string> reasons;
  for (const ConformanceClause& clause : conformance_clauses()) {
    if (clause.name == "beyond_doubles") continue;  // of no option, and long
    const ConformanceVerdict verdict = conformance_of(plain, clause.name);
    if (verdict.conformity == Conformity::not_applicable) reasons.insert(verdict.how);
  }
  EXPECT_THAT(reasons, testing::UnorderedElementsAre(
                           "no batch mode", "no option 'gate_probability'", "no option 'loss'",
                           "no option 'gate_probability' or 'max_iterations'"));
}

TEST(ConformanceBreaches, AnUnknownClauseIsRefused) {
  EXPECT_THROW(conformance_of(good(), "rotated_wordl"), InputError);
}

}  // namespace
}  // namespace fathom::test
