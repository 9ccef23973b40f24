// The rows of charts: closed forms, and a front by brute force.

#include "src/report/chart_rows.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/configuration/axis_words.hpp"
#include "report/made_cells.hpp"
#include "src/report/map_frame.hpp"
#include "src/report/scaled_unit.hpp"
#include "src/report/sweep_lines.hpp"

namespace fathom::test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::Pair;

TEST(ChartRows, ABandEndsAtZeroAboveIt) {
  const auto ends = [](const BandedMean& band) { return std::vector{band.low, band.high}; };
  EXPECT_THAT(ends(banded(1.0, 0.25)), ElementsAre(0.5, 1.5));
  EXPECT_THAT(ends(banded(1.0, 2.0)), ElementsAre(0.0, 5.0));
  EXPECT_THAT(ends(banded(-1.0, 2.0)), ElementsAre(-5.0, 3.0));
  EXPECT_THAT(ends(banded(1.0, std::nullopt)), ElementsAre(1.0, 1.0));
}

// What JavaScript's Number() takes for a number is none of a configuration's.
TEST(ChartRows, LabelsAreNumbersAllOrNone) {
  EXPECT_THAT(numeric_positions({"0.5", "1e1", "-2"}), Optional(ElementsAre(0.5, 10.0, -2.0)));
  for (const char* label : {"", " ", "0x10", "1_000", "ten"}) {
    EXPECT_EQ(numeric_positions({"1", label}), std::nullopt) << label;
  }
}

EstimatorResults estimator(const std::string& name, double error, double cost) {
  return costing(made(name, {error}), cost);
}

TEST(ChartRows, FilesStandByTheirNamesWhereTheseDiffer) {
  const auto ticks = [](const std::vector<std::string>& labels) {
    return ticks_of({.name = "graph", .key = "dataset.path", .labels = labels});
  };
  EXPECT_THAT(ticks({"/a/intel.g2o", "b/ring.g2o"}), ElementsAre("intel.g2o", "ring.g2o"));
  EXPECT_THAT(ticks({"/a/log.g2o", "/b/log.g2o"}), ElementsAre("/a/log.g2o", "/b/log.g2o"));
  EXPECT_THAT(ticks({"a/", "b"}), ElementsAre("a/", "b"));
  EXPECT_THAT(ticks({"sift", "orb"}), ElementsAre("sift", "orb"));
  EXPECT_THAT(ticks({"dive_of_may_1.g2o", "dive_of_may_2.g2o"}), ElementsAre("…1.g2o", "…2.g2o"));
  EXPECT_THAT(ticks({"dive_of_may", "dive_of_mars_2"}), ElementsAre("…may", "…mars_2"));
  EXPECT_THAT(ticks({"dive_of_may"}), ElementsAre("dive_of_may"));
  EXPECT_THAT(ticks({"100000.5", "100000.6"}), ElementsAre("100000.5", "100000.6"));
  EXPECT_THAT(ticks({"M3500a.g2o", "M3500b.g2o"}), ElementsAre("M3500a.g2o", "M3500b.g2o"));
}

TEST(ChartRows, ASweepGoesFromNumberToNumber) {
  const auto order = [](const std::vector<std::string>& labels) {
    std::vector<CellResults> cells;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      cells.push_back(cell_of({estimator("ekf", 1.0, 1.0)}));
      cells.back().cell = i;
    }
    StudyResults results = study_of(std::move(cells), 1, 1);
    results.study.axes = {{.name = "noise", .key = "noise", .labels = labels}};
    return sweeps_along(0, results).at(0).cells;
  };
  EXPECT_THAT(order({"0.1", "0.002", "0.05"}), ElementsAre(1, 2, 0));
  EXPECT_THAT(order({"sift", "orb", "akaze"}), ElementsAre(0, 1, 2));
}

// By the definition, over whole numbers that tie often.
TEST(ChartRows, NoneIsBeatenOnTheFrontAndAllOthersAre) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> draw(1, 6);
  for (int round = 0; round < 200; ++round) {
    CellResults cell;
    for (int i = 0; i < 8; ++i) {
      cell.estimators.push_back(estimator(std::to_string(i), draw(random), draw(random)));
    }
    const auto points = cost_points(cell, kError, "total_ms");
    const auto errors = ranks_of(cell, kError);
    const auto costs = ranks_of(cell, "total_ms");
    const auto front = pareto_front(points, Better::lower);
    const auto is_better = [](double a1, double a2, double b1, double b2) {
      return (a1 < b1 && a2 <= b2) || (a1 <= b1 && a2 < b2);
    };
    for (const CostPoint& one : points) {
      bool is_beaten = false;
      bool is_beaten_by_rank = false;  // what the page draws
      for (const CostPoint& other : points) {
        is_beaten |= is_better(other.error, other.cost, one.error, one.cost);
        is_beaten_by_rank |= is_better(static_cast<double>(errors.at(other.estimator)),
                                       static_cast<double>(costs.at(other.estimator)),
                                       static_cast<double>(errors.at(one.estimator)),
                                       static_cast<double>(costs.at(one.estimator)));
      }
      const bool is_on_it = std::ranges::count(front, one.estimator, &CostPoint::estimator) == 1;
      EXPECT_NE(is_on_it, is_beaten);
      EXPECT_EQ(is_beaten_by_rank, is_beaten);
    }
    EXPECT_TRUE(std::ranges::is_sorted(front, {}, &CostPoint::cost));
  }
}

TEST(ChartRows, OptimaThatDifferInTheTenthDigitTie) {
  CellResults cell;
  cell.estimators = {estimator("slow", 1.0 - 1e-9, 9.0), estimator("fast", 1.0, 1.0),
                     estimator("worse", 1.001, 5.0)};
  const auto front = pareto_front(cost_points(cell, kError, "total_ms"), Better::lower);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].estimator, "fast");
  EXPECT_THAT(ranks_of(cell, kError),
              ElementsAre(Pair("fast", 0), Pair("slow", 0), Pair("worse", 2)));
  EXPECT_THAT(ranks_of(cell, "anees"), IsEmpty());
}

// What an estimator lacks may be its hard trials: its own mean is of easier ones.
TEST(ChartRows, WhoLacksTheMetricInATrialIsOnNoFront) {
  EstimatorResults partly = costing(made("partly", {1.5, 15.0}), 1.0);
  partly.runs[1].metrics.erase(kError);
  partly.metrics[kError].moments.mean = 1.5;
  const CellResults cell = cell_of({costing(made("all", {1.0, 10.0}), 10.0), partly});
  EXPECT_THAT(ranks_of(cell, kError), ElementsAre(Pair("all", 0)));
  const auto front = pareto_front(cost_points(cell, kError, "total_ms"), Better::lower);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].estimator, "all");
}

// Of a study that is not finished, over the trials that all have run.
TEST(ChartRows, PointsThatAreComparedAreOfTheSameTrials) {
  const CellResults cell =
      cell_of({costing(made("longer", {1.0, 50.0}), 1.0), costing(made("shorter", {2.0}), 1.0)});
  EXPECT_THAT(ranks_of(cell, kError), ElementsAre(Pair("longer", 0), Pair("shorter", 1)));
  const auto points = cost_points(cell, kError, "total_ms");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].error, 1.0);
  const auto front = pareto_front(points, Better::lower);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].estimator, "longer");
}

// A mean that leaves out the trials that failed flatters, and F ranks where measurements fit alone.
TEST(ChartRows, WhatIsNotRankedIsOnNoFrontAndBeatsNobody) {
  CellResults cell;
  cell.estimators = {estimator("failed", 0.5, 0.5), estimator("good", 1.0, 1.0)};
  cell.estimators[0].done = 0;
  const auto points = cost_points(cell, kError, "total_ms");
  EXPECT_EQ(points.size(), 2u);
  const auto front = pareto_front(points, Better::lower);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].estimator, "good");
  EXPECT_THAT(ranks_of(cell, kError), ElementsAre(Pair("good", 0)));
  for (EstimatorResults& one : cell.estimators) {
    one.metrics["chi2"].moments.mean = 1000.0;
    one.runs[0].metrics["chi2"] = 1000.0;
    one.consistency["chi2_optimum"].moments.mean = 900.0;
    one.consistency["degrees_of_freedom"].moments.mean = 90.0;
  }
  EXPECT_THAT(ranks_of(cell, "chi2"), IsEmpty());
  EXPECT_THAT(pareto_front(cost_points(cell, "chi2", "total_ms"), Better::lower), IsEmpty());
}

// The interval of a few surveys' mean may reach zero; the estimator is drawn nevertheless.
TEST(ChartRows, ACostWhoseIntervalReachesZeroIsDrawnFromItsMeanOn) {
  CellResults cell;
  cell.estimators = {estimator("wide", 1.0, 2.0), estimator("free", 1.0, 0.0)};
  cell.estimators[0].metrics["total_ms"].interval = Interval{-1.0, 5.0};
  const auto points = cost_points(cell, kError, "total_ms");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].estimator, "wide");
  EXPECT_EQ(points[0].costs.low, 2.0);
  EXPECT_EQ(points[0].costs.high, 5.0);
}

TEST(ChartRows, OutcomesAreInTheirOrderAndEndWithWhatDidNotRun) {
  EstimatorResults one;
  one.runs.resize(5);
  one.outcomes = {{"crashed", 1}, {"a new one", 1}, {"converged", 2}, {"iteration_limit", 1}};
  StudyDescription study;
  study.surveys = 2;
  study.trials = 3;
  EXPECT_THAT(outcome_counts(one, study),
              ElementsAre(Pair("converged", 2), Pair("iteration_limit", 1), Pair("crashed", 1),
                          Pair("a new one", 1), Pair("not run", 1)));
}

// axes · axesᵀ is 4 P, whatever the directions of the axes are.
TEST(ChartRows, TheAxesOfAnEllipseAreTheRootOfFourTimesTheCovariance) {
  Eigen::Matrix2d P;
  P << 4.0, 1.5, 1.5, 1.0;
  const auto axes = two_sigma_axes(P);
  ASSERT_TRUE(axes.has_value());
  EXPECT_LT((*axes * axes->transpose() - 4.0 * P).norm(), 1e-12);
  EXPECT_EQ(two_sigma_axes(Eigen::Matrix2d::Zero()), std::nullopt);
  EXPECT_EQ(two_sigma_axes(Eigen::Matrix2d::Constant(std::nan(""))), std::nullopt);
}

// The table that the page looks up, beside the function.
TEST(ChartRows, TheTableOfUnitsSaysWhatTheFunctionSays) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> magnitude(-30.0, 30.0);
  for (const char* unit : {"m", "rad", "ms", "s", "bytes", "", "1/m"}) {
    const auto steps = reading_units(unit);
    for (int i = 0; i < 2000; ++i) {
      const double value = std::pow(10.0, magnitude(random));
      const UnitStep* found = &steps.front();
      for (const UnitStep& step : steps) {
        if (value >= step.least) found = &step;
      }
      const ScaledUnit expected = reading_unit(unit, -value);
      EXPECT_EQ(found->unit.text, expected.text) << value << " " << unit;
      EXPECT_EQ(found->unit.factor, expected.factor) << value << " " << unit;
    }
  }
}

}  // namespace
}  // namespace fathom::test
