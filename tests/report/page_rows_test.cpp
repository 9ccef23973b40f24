// The rows of the page against those of the figures.

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/page_data.hpp"
#include "report/study_fixture.hpp"
#include "src/report/chart_rows.hpp"
#include "src/report/regime_map.hpp"
#include "src/report/trajectory_map.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;

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
  EXPECT_EQ(page_["estimators"][1]["mark"], "circle");
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
    for (const DrawnRun& run : examples_[c].runs) all.push_back(run.series());
    all.push_back({"ground truth", {}, examples_[c].truth, {}, {}, false});
    const Eigen::AlignedBox2d extent = map_extent(all);
    EXPECT_NEAR(cell["example"]["extent"]["x_m"][1], extent.max().x(), 1e-4);
    EXPECT_NEAR(cell["example"]["extent"]["y_m"][0], extent.min().y(), 1e-4);
  }
}

// Keyframe 4 and 5 had no update; thinning leaves no gap.
TEST_F(PageRows, UpdatesAreInPiecesWithoutAGap) {
  const auto updates_of = [](const std::vector<double>& keyframes) {
    const TemporaryFolder folder;
    StudyDescription study;
    study.estimators = {{"a", "ekf"}};
    ResultStore store = ResultStore::write(folder.path(), study, "");
    RunRecord run;
    run.key = {0, 0, 0, "a"};
    run.outcome = "converged";
    run.series["update_keyframe"] = keyframes;
    run.series["update_ms"].assign(keyframes.size(), 1.0);
    store.add(run);
    store.finish();
    const Json page = data_of_page(page_of(ResultStore::open(folder.path())));
    return page["cells"][0]["estimators"][0]["updates"];
  };
  EXPECT_EQ(updates_of({2, 3, 6, 7, 8, 10})["piece"], Json::parse("[0, 0, 1, 1, 1, 2]"));
  std::vector<double> many(50000);
  std::iota(many.begin(), many.end(), 0.0);
  const Json pieces = updates_of(many)["piece"];
  EXPECT_LT(pieces.size(), many.size());
  EXPECT_EQ(pieces, Json(std::vector<int>(pieces.size(), 0)));
}

// The unit of a swept key stands where neither the name of the axis nor the label says it.
TEST_F(PageRows, SweptValuesHaveTheirUnit) {
  const TemporaryFolder folder;
  StudyDescription study;
  study.estimators = {{"a", "ekf"}};
  study.axes = {{"heading noise", "dataset.odometry.sigma_theta_rad", {"0.002"}},
                {"reach_m", "dataset.loops.max_distance_m", {"4"}},
                {"interval", "dataset.compass.interval_s", {"off", "10"}},
                {"sigma", "dataset.compass.sigma_rad", {"1°"}},
                {"water", "dataset.water.attenuation_per_m", {"0.15"}},
                {"loops", "dataset.loops.max_per_keyframe", {"2"}}};
  ResultStore store = ResultStore::write(folder.path(), study, "");
  RunRecord run;
  run.key = {1, 0, 0, "a"};
  run.outcome = "converged";
  store.add(run);
  store.finish();
  const Json page = data_of_page(page_of(ResultStore::open(folder.path())));
  EXPECT_EQ(page["cells"][0]["label"],
            "heading noise 0.002 rad, reach 4 m, interval 10 s, sigma 1°, water 0.15 1/m, loops 2");
  EXPECT_EQ(page["axes"][0]["title"], "heading noise (rad)");
  EXPECT_EQ(page["axes"][1]["title"], "reach (m)");
  EXPECT_EQ(page["axes"][2]["texts"], Json({"interval off", "interval 10 s"}));
  EXPECT_EQ(page["axes"][3]["title"], "sigma");
}

TEST_F(PageRows, SquaresOfTheRegimeMapAreThoseOfTheFigure) {
  make({});
  EXPECT_EQ(page_["regimes"]["across"], 0);
  EXPECT_EQ(page_["regimes"]["up"], 1);
  const std::string metric = "mean_position_error_m";
  for (std::size_t c = 0; c < results_.cells.size(); ++c) {
    const CellResults& cell = results_.cells[c];
    const auto squares = regime_squares(cell, metric, {});
    for (std::size_t e = 0; e < cell.estimators.size(); ++e) {
      const Json& drawn = page_["cells"][c]["estimators"][e]["metrics"][metric];
      const auto& square = squares[e];
      ASSERT_EQ(drawn.contains("square"), square.has_value()) << c << " " << e;
      if (!square) continue;
      EXPECT_EQ(drawn["square"][0], hex(square->shade.fill));
      EXPECT_EQ(drawn["square"][1], square->shade.ink == palette::white);
      EXPECT_NEAR(drawn["square"][2], *square->relative, kRounding * *square->relative);
    }
  }
}

// Of a study that is not finished: ranks are over the trials that all have run, and means over
// these stand beside the estimators' own.
TEST(PageOfAStudy, RanksAreOfTheSameTrials) {
  const TemporaryFolder folder;
  StudyDescription study;
  study.estimators = {{"longer", "ekf"}, {"shorter", "ekf"}};
  study.metrics = {"mean_position_error_m"};
  study.trials = 2;
  ResultStore store = ResultStore::write(folder.path(), study, "{}");
  const auto add = [&store](const std::string& name, std::size_t trial, double error_m) {
    RunRecord run;
    run.key = {0, 0, trial, name};
    run.outcome = "converged";
    run.metrics["mean_position_error_m"] = error_m;
    store.add(run);
  };
  add("longer", 0, 1.0);
  add("longer", 1, 50.0);
  add("shorter", 0, 2.0);
  store.finish();
  const Json data = data_of_page(page_of(ResultStore::open(folder.path())));
  const auto of = [&data](std::size_t estimator) -> const Json& {
    const auto place = data["cells"][0]["estimators"].size() - 2 + estimator;
    return data["cells"][0]["estimators"][place]["metrics"]["mean_position_error_m"];
  };
  EXPECT_EQ(of(0)["mean"], 25.5);
  EXPECT_EQ(of(0)["rank"], 0);
  EXPECT_EQ(of(0)["ranked"]["mean"], 1.0);
  EXPECT_EQ(of(0)["ranked"]["n"], 1);
  EXPECT_EQ(of(1)["rank"], 1);
  EXPECT_FALSE(of(1).contains("ranked"));
}

// A pose that no map can show breaks the line, and does not decide what is shown.
TEST(PageOfARun, APoseThatIsNotFiniteIsNullOnThePage) {
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
