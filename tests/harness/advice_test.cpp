// The rule of docs/which_back_end.md: what it says of drawn logs, and that it holds there.

#include "fathom/harness/advice.hpp"

#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kLoops =
    "  odometry: {sigma_x_m: 0.01, sigma_y_m: 0.01, sigma_theta_rad: NOISE}\n"
    "  loops: {max_distance_m: 1.2, probability: 1, max_per_keyframe: 1, sigma_x_m: 0.005,"
    " sigma_y_m: 0.005, sigma_theta_rad: 0.003}\n";
// Closed once, at its end, which only touches its start.
constexpr const char* kCircuit =
    "dataset:\n  type: simulated_log\n"
    "  mission: {type: single_loop, loop_length_m: 40, loop_width_m: 10, loop_overrun_m: 0}\n";
constexpr const char* kLegs =
    "dataset:\n  type: simulated_log\n"
    "  mission: {type: sweep, legs: 6, leg_length_m: 10, leg_spacing_m: 1.0}\n";

MeasurementLog drawn(const std::string& mission, const std::string& noise, std::uint64_t trial) {
  std::string text = mission + kLoops;
  text.replace(text.find("NOISE"), 5, noise);
  const Configuration configuration = test::configured(text);
  const Recorder recorder(configuration);
  return recorder.record(configuration, configuration.reference, builtin_estimators(), {7, trial})
      .log;
}

double chi2_of(const MeasurementLog& log, const std::string& estimator) {
  ReplayOptions options;
  options.covariances = false;
  return chi2(log, replay(log, builtin_estimators().find(estimator), {}, options).trajectory);
}

double optimum_of(const MeasurementLog& log) {
  return batch_optimum(log, builtin_estimators())->chi2;
}

TEST(Advice, OfGoodHeadingsIsTheSmootherAndTheFilterEndsThereToo) {
  for (std::uint64_t trial = 0; trial < 3; ++trial) {
    const MeasurementLog log = drawn(kLegs, "0.0005", trial);
    const LoopTerms terms = loop_terms(log);
    EXPECT_LT(terms.curvature, kCurvatureOfFilters);
    const Advice advice = advise(terms);
    EXPECT_EQ(advice.estimator, "incremental_smoother");
    EXPECT_THAT(text_of(advice),
                AllOf(StartsWith("for this log: incremental_smoother, since its loops miss by up "
                                 "to 0.0"),
                      HasSubstr(" rad (sigma "), HasSubstr(" a keyframe, the longest over "),
                      HasSubstr("so trajectory_iekf ends there, too")));
    const double optimum = optimum_of(log);
    EXPECT_LT(chi2_of(log, "incremental_smoother"), optimum * 1.0001);
    EXPECT_LT(chi2_of(log, "trajectory_iekf"), optimum * 1.01);
  }
}

TEST(Advice, OfPoorHeadingsIsWhatFindsTheMinimum) {
  int beyond = 0;
  for (std::uint64_t trial = 0; trial < 8; ++trial) {
    const MeasurementLog log = drawn(kCircuit, "0.05", trial);
    const LoopTerms terms = loop_terms(log);
    if (terms.loops == 0) continue;  // its end missed its start
    const double optimum = optimum_of(log);
    const Advice advice = advise(terms);
    EXPECT_LE(chi2_of(log, advice.estimator), optimum * 1.0001 + 1e-3);
    if (!(terms.most_turned.misfit_rad() > kMisfitOfWrongMinima_rad)) continue;
    ++beyond;
    EXPECT_EQ(advice.estimator, "sparse_gauss_newton");
    EXPECT_THAT(advice.since, AllOf(HasSubstr("beyond 0.3 rad, where wrong minima begin"),
                                    HasSubstr("filters may end elsewhere")));
  }
  EXPECT_GT(beyond, 0) << "none of these trials shows what the rule is for";
}

TEST(Advice, BetweenThemIsTheSmootherAlone) {
  const MeasurementLog log = drawn(kCircuit, "0.005", 1);
  const Advice advice = advise(loop_terms(log));
  EXPECT_EQ(advice.estimator, "incremental_smoother");
  EXPECT_THAT(advice.since, HasSubstr("filters may end elsewhere"));
  EXPECT_LT(chi2_of(log, "incremental_smoother"), optimum_of(log) + 1e-3);
}

TEST(Advice, WithoutLoops) {
  MeasurementLog log;
  log.add_keyframe(
      RelativePose::from_covariance(0, 1, {1.0, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()));
  EXPECT_EQ(text_of(advise(loop_terms(log))),
            "for this log: incremental_smoother, since no loop closes a cycle, so nothing bends "
            "the map");
}

TEST(Advice, OfASurveyGoesByDeadReckoningAlone) {
  Outlook outlook;
  EXPECT_FALSE(advise(outlook));
  outlook.widest = {0.1, 120.0};
  EXPECT_EQ(text_of(*advise(outlook), "survey"),
            "for this survey: incremental_smoother, since dead reckoning leaves a heading sigma of "
            "0.1 rad over the 120 m between the keyframes of a loop; twice that is within 0.3 rad, "
            "below which no wrong minimum was met");
  outlook.widest = {0.2, 120.0};
  EXPECT_EQ(advise(outlook)->estimator, "sparse_gauss_newton");
}

// None of these graphs chose a number of the rule.
TEST(Advice, HoldsOnRecordedGraphs) {
  for (const std::string graph : {"ring", "CSAIL", "MIT", "intel"}) {
    FATHOM_REQUIRE_DATA("pose_graphs/" + graph + ".g2o");
    const MeasurementLog log = read_g2o(test::data_path("pose_graphs/" + graph + ".g2o"));
    const Advice advice = advise(loop_terms(log));
    EXPECT_EQ(advice.estimator, graph == "MIT" ? "sparse_gauss_newton" : "incremental_smoother")
        << graph;
    EXPECT_LT(chi2_of(log, advice.estimator), 1.0001 * chi2_of(log, "sparse_gauss_newton"))
        << graph;
  }
}

}  // namespace
}  // namespace fathom
