#include "fathom/measurements/loop_terms.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"

namespace fathom {
namespace {

constexpr double kStepVariance = 1e-3;  // of a heading, rad²

Eigen::Matrix3d diagonal(double position, double heading) {
  return Eigen::Vector3d(position, position, heading).asDiagonal();
}

RelativePose measured(std::size_t from, std::size_t to, const Pose& motion, double scale = 1.0) {
  return RelativePose::from_covariance(from, to, motion, scale * diagonal(4e-4, 1e-4));
}

// Straight on, a metre a step.
MeasurementLog straight(std::size_t keyframes, double scale = 1.0) {
  MeasurementLog log;
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0},
                                                   scale * diagonal(1e-2, kStepVariance)));
  }
  return log;
}

TEST(LoopTerms, OfOneLoopByHand) {
  MeasurementLog log = straight(4);
  log.add_registration(measured(0, 3, {3.1, 0.0, 0.2}));
  const LoopTerms terms = loop_terms(log);
  EXPECT_EQ(terms.keyframes, 4U);
  EXPECT_EQ(terms.loops, 1U);
  EXPECT_DOUBLE_EQ(terms.loops_per_keyframe(), 0.25);
  EXPECT_DOUBLE_EQ(terms.longest_m, 3.0);
  const LoopClosure& loop = terms.most_turned;
  EXPECT_NEAR(loop.misfit_rad(), 0.2, 1e-12);
  EXPECT_NEAR(loop.misfit_m(), 0.1, 1e-12);
  EXPECT_NEAR(loop.sigma_rad(), std::sqrt(3 * kStepVariance + 1e-4), 1e-12);
  // Across: the levers of the turns, 2 and 1 m, beside the steps' own.
  EXPECT_NEAR(loop.sigma_m(), std::sqrt(3e-2 + 5 * kStepVariance + 4e-4), 1e-12);
  // ½ · 3 m · 0.2² of 20 mm; one loop sets no scale.
  EXPECT_NEAR(terms.curvature, 3.0, 1e-9);
}

TEST(LoopTerms, FromTheOtherEndAreTheSame) {
  MeasurementLog log = straight(4);
  log.add_registration(measured(0, 3, {3.1, 0.0, 0.2}).reversed());
  const LoopTerms terms = loop_terms(log);
  EXPECT_NEAR(terms.most_turned.misfit_rad(), 0.2, 1e-12);
  EXPECT_NEAR(terms.most_turned.sigma_rad(), std::sqrt(3 * kStepVariance + 1e-4), 1e-12);
}

TEST(LoopTerms, AHeadingIsWrapped) {
  MeasurementLog log = straight(4);
  log.add_registration(measured(0, 3, {3.0, 0.0, 2.0 * std::numbers::pi - 0.1}));
  EXPECT_NEAR(loop_terms(log).most_turned.misfit_rad(), 0.1, 1e-12);
}

// An earlier loop is a way; one of the same keyframe is none, as both arrive at once.
TEST(LoopTerms, GoTheWayThatWasKnownBestBefore) {
  MeasurementLog log = straight(3);
  log.add_registration(measured(0, 2, {2.0, 0.0, 0.1}));
  log.add_keyframe(measured(2, 3, {1.0, 0.0, 0.0}));
  log.add_registration(measured(0, 3, {3.0, 0.0, 0.1}));
  log.add_registration(measured(1, 3, {2.0, 0.0, 0.0}));
  const auto loops = loop_closures(log);
  ASSERT_EQ(loops.size(), 3U);
  EXPECT_NEAR(loops[1].misfit_rad(), 0.0, 1e-12);
  EXPECT_NEAR(loops[1].sigma_rad(), std::sqrt(3e-4), 1e-12);
  // From 1 to 2 by the step: over keyframe 0 its heading has more variance.
  EXPECT_NEAR(loops[2].sigma_rad(), std::sqrt(kStepVariance + 2e-4), 1e-12);
  EXPECT_DOUBLE_EQ(loops[2].way_m, 2.0);
}

TEST(LoopTerms, ALoopOverAHoleClosesNothing) {
  MeasurementLog log = straight(2);
  RelativePose hole = measured(1, 2, {1.0, 0.0, 0.0});
  hole.is_hole = true;
  log.add_keyframe(hole);
  log.add_registration(measured(1, 2, {1.0, 0.0, 0.5}));
  log.add_keyframe(measured(2, 3, {1.0, 0.0, 0.0}));
  EXPECT_EQ(loop_terms(log).loops, 0U);
  log.add_registration(measured(0, 3, {3.0, 0.0, 0.5}));
  EXPECT_EQ(loop_terms(log).loops, 1U);
}

// No estimate changes where all covariances are so many times as large, and no term of the rule.
TEST(LoopTerms, ACommonScaleOfCovariancesChangesNoTerm) {
  const auto walked = [](double scale) {
    MeasurementLog log = straight(4, scale);
    for (int k = 0; k < 20; ++k) {
      const auto newest = log.size();
      log.add_keyframe(RelativePose::from_covariance(newest - 1, newest, {1.0, 0.0, 0.0},
                                                     scale * diagonal(1e-2, kStepVariance)));
      log.add_registration(measured(newest - 3, newest, {3.0, 0.02, 0.03 + 0.002 * k}, scale));
    }
    return loop_terms(log);
  };
  const LoopTerms terms = walked(1.0);
  const LoopTerms larger = walked(100.0);
  EXPECT_NEAR(larger.most_turned.misfit_rad(), terms.most_turned.misfit_rad(), 1e-12);
  EXPECT_GT(terms.curvature, 0.0);
  EXPECT_NEAR(larger.curvature, terms.curvature, 1e-9 * terms.curvature);
}

TEST(LoopTerms, OfLoopsThatAgreeToTheLastBitNothingIsLeft) {
  MeasurementLog log = straight(16);
  for (std::size_t k = 0; k < kLoopsForScale + 1; ++k) {
    log.add_registration(measured(k, 15, {15.0 - static_cast<double>(k), 0.0, 0.0}));
  }
  EXPECT_EQ(loop_terms(log).curvature, 0.0);
  EXPECT_EQ(loop_terms(straight(4)).loops, 0U);
}

// Against a search in another language, over dense lists.
TEST(LoopTerms, OfRecordedGraphs) {
  struct Case {
    const char* graph;
    double misfit_rad;
    double longest_m;
  };
  for (const Case& one : {Case{"ring", 0.109, 481}, Case{"CSAIL", 0.0924, 139},
                          Case{"intel", 0.0986, 73.7}, Case{"MIT", 1.96, 360}}) {
    const std::string file = std::string("pose_graphs/") + one.graph + ".g2o";
    FATHOM_REQUIRE_DATA(file);
    const LoopTerms terms = loop_terms(read_g2o(test::data_path(file)));
    EXPECT_NEAR(terms.most_turned.misfit_rad(), one.misfit_rad, 0.005 * one.misfit_rad)
        << one.graph;
    EXPECT_NEAR(terms.longest_m, one.longest_m, 0.005 * one.longest_m) << one.graph;
  }
}

}  // namespace
}  // namespace fathom
