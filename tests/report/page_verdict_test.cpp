// The answer in the data of report.html.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/made_cells.hpp"
#include "report/page_data.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The fixture's first estimator is the best by far; of the last cell one failed and is not ranked.
TEST(PageVerdict, HasTheVerdictAndTheRankings) {
  FixtureOptions options;
  options.data_set = "simulated_log";
  options.trials = 8;
  const Json data = data_of(options);
  EXPECT_EQ(data["verdict"]["metric"], "mean_position_error_m");
  EXPECT_THAT(data["verdict"]["answer"].dump(), HasSubstr("graph is worse in"));
  EXPECT_THAT(
      data["verdict"]["failed"].dump(),
      HasSubstr("a&b_<c>% failed in 2 of 48 runs, in 1 of 6 cells, where it is not ranked."));
  EXPECT_EQ(data["cells"][0]["verdict"]["as_cheap"], Json::array());
  const Json& rankings = data["cells"][0]["rankings"];
  EXPECT_FALSE(rankings.contains("anees"));
  const Json& ranking = rankings["mean_position_error_m"];
  EXPECT_EQ(ranking["best"], "iterated");
  EXPECT_NEAR(ranking["level"], 0.975, 1e-12);
  ASSERT_EQ(ranking["others"].size(), 2u);
  const Json& estimators = data["cells"][0]["estimators"];
  for (const Json& other : ranking["others"]) {
    const Json& one = estimators[other["estimator"] == "graph" ? 3 : 2];
    ASSERT_EQ(one["name"], other["estimator"]);
    const auto mean = [](const Json& entry) {
      return entry["metrics"]["mean_position_error_m"]["mean"].get<double>();
    };
    EXPECT_NEAR(other["mean"], mean(one) - mean(estimators[1]), 1e-5);
    EXPECT_EQ(other["standing"], other["p"] < 0.05 ? "worse" : "not_shown");
  }
  const Json of_one_survey = data_of({});
  EXPECT_THAT(of_one_survey["verdict"]["answer"].dump(),
              HasSubstr("No verdict by mean position error in all 6 cells"));
  EXPECT_EQ(of_one_survey["cells"][0]["rankings"]["mean_position_error_m"]["others"][1]["standing"],
            "not_shown");
  EXPECT_EQ(data["cells"][5]["rankings"]["mean_position_error_m"]["others"].size(), 1u);
  EXPECT_THAT(data["cells"][5]["verdict"]["failed"].dump(), HasSubstr("and is not ranked"));
}

// Of one cell F ranks none, and then of no cell; the first metric that ranks is shown first.
TEST(PageVerdict, ChartsRankByNothingThatTheVerdictRefuses) {
  FixtureOptions options;
  options.misfit = true;
  const Json data = data_of(options);
  EXPECT_EQ(data["verdict"]["metric"], "mean_position_error_m");
  EXPECT_EQ(data["first"]["accuracy"], "mean_position_error_m");
  EXPECT_EQ(data["regimes"]["cheapest"]["metric"], "mean_position_error_m");
  EXPECT_THAT(data["cells"][0]["unranked"]["chi2"].get<std::string>(), HasSubstr("do not fit"));
  EXPECT_EQ(data["cells"][1]["unranked"], Json::object());
  for (std::size_t c = 0; c < 2; ++c) {
    const Json& metrics = data["cells"][c]["estimators"][1]["metrics"];
    EXPECT_EQ(metrics["chi2"].contains("rank"), c == 1);
    EXPECT_TRUE(metrics["chi2"]["square"][2].is_null());
    EXPECT_TRUE(metrics["mean_position_error_m"].contains("rank"));
    EXPECT_FALSE(metrics["mean_position_error_m"]["square"][2].is_null());
  }
  // Without ground truth nothing else ranks.
  options.ground_truth = false;
  const Json without = data_of(options);
  EXPECT_EQ(without["first"]["accuracy"], "chi2");
  EXPECT_FALSE(without["regimes"].contains("cheapest"));
}

// The page counts metrics that occur, the terminal those of the study.
TEST(Verdict, TheCostIsTheFirstThatHasAValue) {
  StudyResults results =
      study_of({surveyed({eight("best", kBest, 8.0), eight("alike", kAlike, 2.0)})}, 8, 1);
  results.study.metrics = {kError, "update_ms.median", "total_ms"};
  for (const auto& occurring : {results.study.metrics, {kError, "total_ms"}}) {
    results.metrics = occurring;
    EXPECT_EQ(study_verdict(results).cost, "total_ms");
    EXPECT_FALSE(study_verdict(results).cost_words.empty());
  }
}

TEST(Verdict, WhatIsMissingOfAStudyOfSeveralCellsIsSaid) {
  StudyResults results = study_of(
      {surveyed({eight("best", kBest), eight("alike", kAlike)}), surveyed({eight("best", kBest)})},
      8, 1);
  results.study.estimators = {{"best", "ekf"}, {"alike", "ekf"}, {"never", "ekf"}};
  for (const char* label : {"a", "b", "c", "d", "e"}) results.empty_cells.emplace_back(label);
  const StudyVerdict verdict = study_verdict(results);
  EXPECT_THAT(verdict.failed,
              ElementsAre("best: 40 of 56 runs are missing.", "alike: 48 of 56 runs are missing.",
                          "never: 56 of 56 runs are missing.",
                          "No run yet in 5 of 7 cells: a; b; c; and 2 more."));
  EXPECT_THAT(verdict.cells[1].failed,
              ElementsAre("alike: 8 of 8 runs are missing.", "never: 8 of 8 runs are missing."));
  // One cell alone has runs.
  results.cells.pop_back();
  results.empty_cells = {"a"};
  EXPECT_THAT(study_verdict(results).failed,
              ElementsAre("never: 8 of 8 runs are missing.", "No run yet in 1 of 2 cells: a."));
}

TEST(Verdict, ASentenceOfCostsHasOneUnit) {
  const StudyVerdict verdict = study_verdict(
      study_of({surveyed({eight("best", kBest, 8.0), eight("alike", kAlike, 0.0035)})}, 8, 1));
  EXPECT_THAT(verdict.cost_words, ElementsAre(AllOf(HasSubstr("alike, "), HasSubstr(" 0.00350 ms."),
                                                    HasSubstr("Dearer: best 8.00 ms."))));
}

// In the second cell both cost the same in the mean, more or less.
TEST(Verdict, TheCheapestIsSaidToBeUnsureWhereOthersAreNotShownToBeDearer) {
  EstimatorResults noisy = eight("alike", kAlike, 0.0035);
  for (std::size_t i = 0; i < noisy.runs.size(); ++i) {
    noisy.runs[i].metrics["total_ms"] *= i % 2 == 0 ? 0.5 : 1.5;
  }
  const StudyVerdict verdict =
      study_verdict(study_of({surveyed({eight("best", kBest, 8.0), eight("alike", kAlike, 0.0035)}),
                              surveyed({eight("best", kBest, 0.0036), noisy})},
                             6, 1));
  EXPECT_THAT(verdict.cells[0].as_cheap, IsEmpty());
  EXPECT_THAT(verdict.cells[1].as_cheap, ElementsAre("best"));
  ASSERT_EQ(verdict.cost_words.size(), 2u);
  EXPECT_EQ(verdict.cost_words[1], "In 1 of 2 cells others as good are not shown to be dearer.");
}

}  // namespace
}  // namespace fathom::test
