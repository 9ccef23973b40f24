// The rows of charts: closed forms, a front by brute force, and the page's against the figures'.

#include "src/report/chart_rows.hpp"

#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/page_data.hpp"
#include "report/study_fixture.hpp"
#include "src/report/map_frame.hpp"
#include "src/report/regime_map.hpp"
#include "src/report/scaled_unit.hpp"
#include "src/report/trajectory_map.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
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
  EstimatorResults one;
  one.name = name;
  one.metrics["ate_rmse_m"].moments.mean = error;
  one.metrics["total_ms"].moments.mean = cost;
  return one;
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
    const auto points = cost_points(cell, "ate_rmse_m", "total_ms");
    const auto errors = ranks_of(cell, "ate_rmse_m");
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
  const auto front = pareto_front(cost_points(cell, "ate_rmse_m", "total_ms"), Better::lower);
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].estimator, "fast");
  EXPECT_THAT(ranks_of(cell, "ate_rmse_m"),
              ElementsAre(Pair("fast", 0), Pair("slow", 0), Pair("worse", 2)));
  EXPECT_THAT(ranks_of(cell, "anees"), IsEmpty());
}

// The interval of a few surveys' mean may reach zero; the estimator is drawn nevertheless.
TEST(ChartRows, ACostWhoseIntervalReachesZeroIsDrawnFromItsMeanOn) {
  CellResults cell;
  cell.estimators = {estimator("wide", 1.0, 2.0), estimator("free", 1.0, 0.0)};
  cell.estimators[0].metrics["total_ms"].interval = Interval{-1.0, 5.0};
  const auto points = cost_points(cell, "ate_rmse_m", "total_ms");
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

class PageRows : public ::testing::Test {
 protected:
  void make(const FixtureOptions& options) {
    write_fixture(folder_ / "study", options);
    const ResultStore store = ResultStore::open(folder_ / "study");
    results_ = study_results(store);
    series_ = study_series(store, results_);
    examples_ = example_trials(store, results_);
    page_ = data_of_page(page_of(store));
  }

  TemporaryFolder folder_;
  StudyResults results_;
  std::vector<std::vector<EstimatorSeries>> series_;
  std::vector<ExampleTrial> examples_;
  Json page_;
};

constexpr double kRounding = 1e-5;

TEST_F(PageRows, AreThoseOfTheFigures) {
  FixtureOptions options;
  options.absolute = true;
  make(options);
  EXPECT_EQ(page_["axes"][0]["positions"], Json::parse("[5, 10, 20]"));
  EXPECT_TRUE(page_["axes"][1]["positions"].is_null());
  for (std::size_t c = 0; c < results_.cells.size(); ++c) {
    const Json& cell = page_["cells"][c];
    const NeesChart nees = nees_chart(results_.cells[c], series_[c]);
    ASSERT_EQ(cell["nees_interval"]["low"].size(), nees.low.size());
    EXPECT_EQ(cell["nees_interval"]["draws"], nees.draws);
    for (std::size_t i = 0; i < nees.low.size(); ++i) {
      EXPECT_EQ(cell["nees_interval"]["keyframe"][i], nees.low[i].x());
      EXPECT_NEAR(cell["nees_interval"]["low"][i], nees.low[i].y(), kRounding);
      EXPECT_NEAR(cell["nees_interval"]["high"][i], nees.high[i].y(), kRounding * 10.0);
    }
    for (std::size_t e = 0; e < results_.cells[c].estimators.size(); ++e) {
      for (const auto& [metric, summary] : results_.cells[c].estimators[e].metrics) {
        const Moments& moments = summary.moments;
        const BandedMean band = banded(moments.mean, moments.standard_deviation);
        const Json& drawn = cell["estimators"][e]["metrics"][metric]["band"];
        EXPECT_NEAR(drawn[0], band.low, kRounding * std::abs(band.low));
        EXPECT_NEAR(drawn[1], band.high, kRounding * std::abs(band.high));
      }
    }
    std::vector<PlotSeries> all;
    for (const ExampleRun& run : examples_[c].runs) all.push_back(run.series());
    all.push_back({"ground truth", {}, examples_[c].truth, {}, {}, false});
    const Eigen::AlignedBox2d extent = map_extent(all);
    EXPECT_NEAR(cell["example"]["extent"]["x_m"][1], extent.max().x(), 1e-4);
    EXPECT_NEAR(cell["example"]["extent"]["y_m"][0], extent.min().y(), 1e-4);
  }
}

TEST_F(PageRows, SquaresOfTheRegimeMapAreThoseOfTheFigure) {
  make({});
  EXPECT_EQ(page_["regimes"]["across"], 0);
  EXPECT_EQ(page_["regimes"]["up"], 1);
  const std::string metric = "mean_position_error_m";
  for (std::size_t c = 0; c < results_.cells.size(); ++c) {
    const CellResults& cell = results_.cells[c];
    for (std::size_t e = 0; e < cell.estimators.size(); ++e) {
      const Json& drawn = page_["cells"][c]["estimators"][e]["metrics"][metric];
      const auto square = regime_square(cell, cell.estimators[e], metric, {});
      ASSERT_EQ(drawn.contains("square"), square.has_value()) << c << " " << e;
      if (!square) continue;
      EXPECT_EQ(drawn["square"][0], hex(square->shade.fill));
      EXPECT_EQ(drawn["square"][1], square->shade.ink == palette::white);
      EXPECT_NEAR(drawn["square"][2], *square->relative, kRounding * *square->relative);
    }
  }
}

// A pose that no map can show breaks the line, and does not decide what is shown.
TEST(ChartRows, APoseThatIsNotFiniteIsNullOnThePage) {
  const TemporaryFolder folder;
  StudyDescription study;
  study.estimators = {{"a", "ekf"}};
  ResultStore store = ResultStore::write(folder.path(), study, "{}");
  RunRecord run;
  run.key = {0, 0, 0, "a"};
  run.outcome = "converged";
  run.series["x_m"] = {0.0, std::nan(""), 4.0, 1e300};
  run.series["y_m"] = {0.0, 1.0, 3.0, 2.0};
  run.series["loop_from"] = {0.0, 0.0};
  run.series["loop_to"] = {2.0, 3.0};
  run.series["loop_fate"] = {0.0, 0.0};
  run.series["absolute_keyframe"] = {2.0, 1.0, 2.0};
  run.series["absolute_fate"] = run.series["absolute_nis"] = {0.0, 0.0, 0.0};
  run.series["absolute_weight"] = {1.0, 1.0, 1.0};
  run.series["absolute_x_m"] = {4.5, 1.0, 1e300};
  run.series["absolute_y_m"] = {3.0, 1.0, 3.0};
  run.series["absolute_cov_xx"] = run.series["absolute_cov_yy"] = {0.01, 0.01, 0.01};
  run.series["absolute_cov_xy"] = {0.0, 0.0, 0.0};
  store.add(run);
  store.finish();
  const Json data = data_of_page(page_of(ResultStore::open(folder.path())));
  const Json& example = data["cells"][0]["example"];
  EXPECT_EQ(example["estimators"][0]["path"]["x_m"], Json::parse("[0, null, 4, null]"));
  EXPECT_EQ(example["estimators"][0]["path"]["y_m"], Json::parse("[0, null, 3, null]"));
  EXPECT_EQ(example["extent"], Json::parse(R"({"x_m": [0, 4.5], "y_m": [0, 3]})"));
  // A loop or a mark at such a pose is counted and not drawn.
  const Json& one = example["estimators"][0];
  EXPECT_EQ(one["loops_in_all"]["used"], 2);
  EXPECT_EQ(one["loops"][0].size(), 8u);
  EXPECT_EQ(one["loops"][1].size(), 4u);
  EXPECT_EQ(one["absolute_in_all"]["fixes"], Json::parse("[3, 0]"));
  ASSERT_EQ(one["absolute"].size(), 1u);
  EXPECT_EQ(one["absolute"][0]["fix_m"], Json::parse("[4.5, 3]"));
}

}  // namespace
}  // namespace fathom::test
