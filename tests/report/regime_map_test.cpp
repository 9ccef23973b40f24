#include "src/report/regime_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/made_cells.hpp"
#include "report/placed_texts.hpp"
#include "report/study_fixture.hpp"
#include "src/report/study_figures.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

EstimatorResults with_means(const std::string& name, double error_m, double total_ms,
                            std::size_t failures = 0) {
  EstimatorResults one = costing(made(name, std::vector<double>(10, error_m)), total_ms);
  for (RunRecord& run : one.runs) run.metrics["anees"] = 1.0;
  one.done = 10 - failures;
  one.metrics["anees"].moments.mean = 1.0;
  return one;
}

TEST(RegimeMap, TheCheapestIsOneOfThoseAsGoodAsTheBest) {
  const CellResults cell =
      cell_of({with_means("best", 1.0, 5.0), with_means("as_good", 1.04, 2.0),
               with_means("dearer", 1.01, 3.0), with_means("worse", 1.06, 1.0)});
  EXPECT_EQ(cheapest_of_the_best(cell, kError, "total_ms"), "as_good");
  EXPECT_THAT(relative_to_best(cell, kError), Contains(Pair("worse", DoubleEq(1.06))));
}

// As F above its optimum: a share of nothing is nothing.
TEST(RegimeMap, WhereTheBestIsZeroRoundingIsAsGood) {
  const CellResults cell = cell_of({with_means("best", 0.0, 5.0), with_means("rounded", 9e-7, 2.0),
                                    with_means("worse", 2e-6, 1.0)});
  EXPECT_THAT(as_good_as_best(cell, kError), ElementsAre("best", "rounded"));
  EXPECT_EQ(cheapest_of_the_best(cell, kError, "total_ms"), "rounded");
}

// Dead reckoning is no choice; a mean that leaves out the trials that failed flatters.
TEST(RegimeMap, DeadReckoningAndEstimatorsThatFailedAreInNoComparison) {
  const CellResults cell =
      cell_of({with_means(kDeadReckoning, 0.1, 0.1), with_means("failed", 0.5, 0.5, 1),
               with_means("good", 1.0, 5.0)});
  EXPECT_EQ(cheapest_of_the_best(cell, kError, "total_ms"), "good");
  EXPECT_THAT(relative_to_best(cell, kError), ElementsAre(Pair("good", 1.0)));
  const CellResults none = cell_of({with_means("failed", 0.5, 0.5, 10)});
  EXPECT_EQ(cheapest_of_the_best(none, kError, "total_ms"), std::nullopt);
}

// The means of one that lacks the metric in the hard trials would be the least.
TEST(RegimeMap, WhoLacksTheMetricInATrialIsInNoComparison) {
  EstimatorResults all = with_means("all", 1.0, 5.0);
  EstimatorResults partly = with_means("partly", 1.5, 1.0);
  for (std::size_t trial = 7; trial < 10; ++trial) {
    all.runs[trial].metrics[kError] = 10.0;
    partly.runs[trial].metrics.erase(kError);
  }
  all.metrics[kError].moments.mean = 3.7;
  const CellResults cell = cell_of({all, partly});
  EXPECT_EQ(cheapest_of_the_best(cell, kError, "total_ms"), "all");
  EXPECT_THAT(relative_to_best(cell, kError), ElementsAre(Pair("all", 1.0)));
  const auto squares = regime_squares(cell, kError, {});
  EXPECT_EQ(squares[0]->relative, 1.0);
  EXPECT_FALSE(squares[1]);
}

// Of a study that is not finished, over the trials that all have run.
TEST(RegimeMap, MeansAreOverTheSameTrials) {
  const CellResults cell =
      cell_of({costing(made("longer", {1.0, 50.0}), 2.0), costing(made("shorter", {2.0}), 1.0)});
  EXPECT_THAT(relative_to_best(cell, kError),
              ElementsAre(Pair("longer", 1.0), Pair("shorter", 2.0)));
  EXPECT_EQ(regime_squares(cell, kError, {})[0]->mean, 1.0);
}

// ANEES has no best: 1 is honest, and less is not better.
TEST(RegimeMap, AMetricWithoutABestHasNoChoice) {
  const CellResults cell = cell_of({with_means("a", 1.0, 5.0), with_means("b", 2.0, 2.0)});
  EXPECT_EQ(cheapest_of_the_best(cell, "anees", "total_ms"), std::nullopt);
  EXPECT_THAT(relative_to_best(cell, "anees"), IsEmpty());
}

StudyResults results_of(const TemporaryFolder& folder, const FixtureOptions& options) {
  write_fixture(folder / "study", options);
  return study_results(ResultStore::open(folder / "study"));
}

TEST(RegimeMap, ThereIsOneForEachPlaceOnTheOtherAxes) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.alignments = {"origin", "se2"};
  const StudyResults results = results_of(folder, options);
  const std::vector<RegimeMap> maps = regime_maps(results);
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_NE(maps[0].others.find("origin"), std::string::npos) << maps[0].others;
  EXPECT_NE(maps[1].others.find("se2"), std::string::npos) << maps[1].others;
  for (std::size_t m = 0; m < maps.size(); ++m) {
    ASSERT_EQ(maps[m].cells.size(), options.separations.size());
    for (std::size_t i = 0; i < options.separations.size(); ++i) {
      ASSERT_EQ(maps[m].cells[i].size(), options.noises.size());
      for (std::size_t j = 0; j < options.noises.size(); ++j) {
        ASSERT_NE(maps[m].cells[i][j], nullptr);
        EXPECT_EQ(results.study.places_of(maps[m].cells[i][j]->cell),
                  (std::vector<std::size_t>{i, j, m}));
      }
    }
  }
}

TEST(RegimeMap, OneAxisHasNone) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.noises.clear();
  EXPECT_TRUE(regime_maps(results_of(folder, options)).empty());
}

// Its words one after the other; lines are broken where they must be.
std::string text_of_figure(const ChartInput& input, const std::string& name) {
  std::string text;
  for (const StudyFigure& figure : study_figures(input)) {
    if (!figure.name.starts_with(name)) continue;
    for (const PlacedText& one : texts_of({kFigureWidth, figure.height}, figure.draw)) {
      text += one.text + " ";
    }
  }
  return text;
}

// A choice is told by its colour and, where colours repeat, by a number in square and legend.
TEST(RegimeMap, ChoicesOfManyEstimatorsHaveNumbers) {
  const TemporaryFolder folder;
  StudyResults results = results_of(folder, {});
  const ResultStore store = ResultStore::open(folder / "study");
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  const ChartInput input{results, series, examples};
  const std::string few = text_of_figure(input, "regime_map");
  EXPECT_THAT(few, AllOf(HasSubstr(" iterated a&b_<c>% graph "), Not(HasSubstr(" 1 iterated"))));
  for (std::size_t i = 0; i < kEstimatorColours; ++i) {
    results.study.estimators.insert(results.study.estimators.begin(), {"idle", "ekf"});
  }
  const std::string many = text_of_figure(input, "regime_map");
  EXPECT_THAT(many, AllOf(HasSubstr(" 9 iterated 10 a&b_<c>% 11 graph "), HasSubstr(" 9 9 ")));
}

// In squares that hold no name it is smaller and shortened.
TEST(RegimeMap, EveryChoiceIsNamed) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.separations.clear();
  options.noises = {"low", "high"};
  for (int i = 1; i <= 12; ++i) options.separations.push_back(std::to_string(i));
  const StudyResults results = results_of(folder, options);
  const ResultStore store = ResultStore::open(folder / "study");
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  std::size_t names = 0;
  for (const StudyFigure& figure : study_figures({results, series, examples})) {
    if (figure.name != "regime_map") continue;
    const PageSize page{kFigureWidth, figure.height};
    const auto texts = texts_of(page, figure.draw);
    expect_tidy(texts, page);
    for (const PlacedText& one : texts) names += one.text.starts_with("it") ? 1 : 0;
  }
  EXPECT_EQ(names, 24u + 2u);  // a heading and the legend
}

// Dead reckoning has no F above the optimum: what is not drawn is in no legend.
TEST(RegimeMap, FiguresOfASweepNameThoseThatTheyDraw) {
  const TemporaryFolder folder;
  StudyResults results = results_of(folder, {});
  const ResultStore store = ResultStore::open(folder / "study");
  auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  const ChartInput input{results, series, examples};
  EXPECT_THAT(text_of_figure(input, "error_by_separation"), HasSubstr("dead reckoning"));
  for (std::size_t c = 0; c < results.cells.size(); ++c) {
    for (std::size_t i = 0; i < results.cells[c].estimators.size(); ++i) {
      if (results.cells[c].estimators[i].name != kDeadReckoning) continue;
      results.cells[c].estimators[i].metrics.clear();
      series[c][i].bounds.reset();
    }
  }
  EXPECT_THAT(text_of_figure(input, "error_by_separation"), Not(HasSubstr("dead reckoning")));
}

// Of the first cell F ranks none: a map that all cells share has then the means of all.
TEST(RegimeMap, FiguresRankByNothingThatTheVerdictRefuses) {
  for (const bool has_truth : {true, false}) {
    const TemporaryFolder folder;
    FixtureOptions options;
    options.misfit = true;
    options.ground_truth = has_truth;
    const StudyResults results = results_of(folder, options);
    const ResultStore store = ResultStore::open(folder / "study");
    const auto series = study_series(store, results);
    const auto examples = example_trials(store, results);
    const ChartInput input{results, series, examples};
    const auto scale = scale_over(results, regime_maps(results).front(), "chi2");
    ASSERT_TRUE(scale);
    EXPECT_FALSE(scale->is_relative);
    const std::string map = text_of_figure(input, "regime_map");
    const std::string cost = text_of_figure(input, "accuracy_against_cost_separation_5");
    if (has_truth) {
      EXPECT_THAT(map, AllOf(HasSubstr("mean position error"), HasSubstr("cheapest within 5 %")));
      EXPECT_THAT(cost, HasSubstr("Pareto front"));
    } else {
      EXPECT_THAT(map, AllOf(HasSubstr("no best one is shown: where measurements"),
                             Not(HasSubstr("cheapest"))));
      EXPECT_THAT(cost, HasSubstr("no Pareto front: where measurements"));
    }
  }
}

}  // namespace
}  // namespace fathom::test
