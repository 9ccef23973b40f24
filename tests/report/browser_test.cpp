// report.html in a real browser: its self-test switches estimators, cells, the theme and the map,
// and writes what became of the charts into the page.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/browser_page.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;

TEST_F(Browser, DrawsEveryChartAndTakesAnEstimatorOffAllOfThem) {
  const Json result = self_test_of({});
  ASSERT_FALSE(result.is_null()) << "the page's scripts did not run to their end";
  EXPECT_EQ(result["errors"], Json::array());
  const std::vector<std::string> charts{"forest",  "trajectories", "sweep",
                                        "regimes", "keyframes",    "updates",
                                        "pareto",  "outcomes",     "registrations"};
  EXPECT_EQ(result["marks"].size(), charts.size());
  for (const char* name : {"iterated", "a&b_<c>%", "graph"}) {
    const Json& one = result["estimators"].at(name);
    for (const std::string& chart : charts) {
      if (chart == "registrations") continue;  // they share a map
      EXPECT_GT(one["before"].at(chart), 0) << name << ", " << chart;
      EXPECT_EQ(one["off"].at(chart), 0) << name << ", " << chart;
      EXPECT_EQ(one["again"].at(chart), one["before"].at(chart)) << name << ", " << chart;
    }
  }
  const Json& baseline = result["estimators"].at(kDeadReckoning);
  for (const char* chart : {"forest", "trajectories", "sweep", "keyframes", "pareto"}) {
    EXPECT_GT(baseline["before"].at(chart), 0) << chart;
    EXPECT_EQ(baseline["off"].at(chart), 0) << chart;
  }
}

TEST_F(Browser, DrawsEveryCellAndTable) {
  const Json result = self_test_of({});
  ASSERT_FALSE(result.is_null());
  // All layers of the map, without its ellipses, without its loops.
  ASSERT_EQ(result["layers"].size(), 3u);
  EXPECT_LT(result["layers"][1], result["layers"][0]);
  EXPECT_LT(result["layers"][2], result["layers"][0]);
  ASSERT_EQ(result["cells"].size(), 6u);
  for (const Json& cell : result["cells"]) {
    for (const auto& [chart, marks] : cell.items()) EXPECT_GT(marks, 0) << chart;
  }
  // In the last cell an estimator has no path on trial 0, but outcomes of two kinds more.
  EXPECT_LT(result["cells"][5]["trajectories"], result["cells"][0]["trajectories"]);
  EXPECT_GT(result["cells"][5]["outcomes"], result["cells"][0]["outcomes"]);
  EXPECT_EQ(result["tables"]["cells-table"], 7);    // a header and six cells
  EXPECT_EQ(result["tables"]["summary-table"], 6);  // a header, the outcome and four metrics
  EXPECT_EQ(result["tables"]["paired-table"], 9);   // and two estimators by four metrics
  EXPECT_EQ(result["theme"], "dark");
}

TEST_F(Browser, AnswersFirstAndMarksTheBestOfEveryRow) {
  FixtureOptions options;
  options.size = 0.01;
  const Json answer = self_test_of({options})["answer"];
  ASSERT_FALSE(answer["words"].empty());
  EXPECT_THAT(answer["words"].dump(), ::testing::HasSubstr("mean position error"));
  EXPECT_THAT(answer["doubts"].dump(), ::testing::HasSubstr("One survey: intervals"));
  EXPECT_EQ(answer["best"], 6);
  EXPECT_THAT(answer["header"].dump(), ::testing::HasSubstr("iterated (mm)"));
  EXPECT_EQ(answer["overflow"], Json::array());
  // The choice above the table changes both the table and the first chart.
  EXPECT_EQ(answer["other"]["title"], "Estimate, time in every cell");
  EXPECT_THAT(answer["other"]["header"].dump(), ::testing::HasSubstr("iterated (ms)"));
  EXPECT_GT(answer["other"]["forest"], 0);
}

TEST_F(Browser, AxesSwitchAndDeadReckoningLeavesTheScaleThatItHides) {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  options.baseline = 10.0;
  const Json answer = self_test_of({options})["answer"];
  const Json usual{{"forest", {"linear"}},
                   {"keyframes", {"linear", "linear", "log"}},
                   {"updates", {"linear"}},
                   {"pareto", {"linear"}}};
  EXPECT_EQ(answer["usual"], usual);
  for (const auto& [axes, chart] : {std::pair("linear", "linear"), std::pair("log", "log")}) {
    for (const auto& [name, types] : answer[axes].items()) {
      for (const Json& type : types) EXPECT_EQ(type, chart) << name;
    }
  }
  // A logarithmic axis ends near its values, and labels 1, 2 and 5.
  EXPECT_NEAR(answer["axis"]["below"], 1.1, 0.02);
  EXPECT_NEAR(answer["axis"]["above"], 1.1, 0.02);
  EXPECT_GT(answer["axis"]["round"].size(), 3u);
  EXPECT_THAT(answer["axis"]["labels"].get<std::vector<std::string>>(),
              ::testing::IsSupersetOf(answer["axis"]["round"].get<std::vector<std::string>>()));
  const std::string note = "Dead reckoning is off the scale: mean position error ";
  EXPECT_THAT(answer["notes"].dump(), ::testing::HasSubstr(note));
  EXPECT_THAT(answer["notes"].dump(), ::testing::HasSubstr("position error up to "));
  EXPECT_THAT(answer["notesOnScale"].dump(), ::testing::Not(::testing::HasSubstr("off the scale")));
  EXPECT_THAT(self_test_of({})["answer"]["notes"].dump(),
              ::testing::Not(::testing::HasSubstr("off the scale")));
  // A page of one cell speaks of none.
  EXPECT_EQ(answer["best"], 1);
  EXPECT_THAT(answer["words"].dump() + answer["doubts"].dump() + answer["header"].dump(),
              ::testing::Not(::testing::HasSubstr("cell")));
}

// Between numbers there is a line, between words a bar at each.
TEST_F(Browser, NoLineJoinsWhatHasNothingInBetween) {
  FixtureOptions numbers;
  numbers.noises.clear();
  FixtureOptions words;
  words.separations.clear();
  const Json joined = self_test_of({numbers})["answer"]["sweep"];
  const Json apart = self_test_of({words})["answer"]["sweep"];
  EXPECT_GT(joined[0], 0);
  EXPECT_EQ(joined[1], 0);
  EXPECT_EQ(apart[0], 0);
  EXPECT_GT(apart[1], 0);
  EXPECT_GT(apart[2], 0);
}

// Estimates that agree are one line on which their colours take turns, with how near they are.
TEST_F(Browser, WhatAgreesIsDrawnOnceAndSaysHowNearItIs) {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  options.size = 1e-4;
  options.baseline = 1e4;
  const Json turns = self_test_of({options})["turns"];
  EXPECT_THAT(turns[0]["note"].dump(),
              ::testing::ContainsRegex("iterated, a&b_<c>% and graph lie within .* of each other "
                                       "and within .* of ground truth"));
  EXPECT_THAT(turns[1]["note"].dump(), ::testing::HasSubstr("a&b_<c>% and graph lie within"));
  EXPECT_EQ(turns[0]["lines"][0]["dashes"], "");
  EXPECT_EQ(turns[0]["lines"][1]["dashes"], "9,18");
  EXPECT_EQ(turns[0]["lines"][1]["offset"], "-9");
  EXPECT_EQ(turns[0]["lines"][2]["offset"], "-18");
  EXPECT_LT(turns[0]["lines"][2]["width"], 3.0);
  EXPECT_EQ(turns[0]["maps"], Json({"iterated, a&b_<c>% and graph: 26 used, 3 rejected, 1 lost"}));
  EXPECT_EQ(turns[1]["maps"], Json({"a&b_<c>% and graph: 26 used, 3 rejected, 1 lost"}));
  // Without the first one the second is whole.
  EXPECT_EQ(turns[1]["lines"][1]["dashes"], "");
  EXPECT_EQ(turns[1]["lines"][2]["dashes"], "9,9");
}

TEST_F(Browser, TheMapHasEqualAxesXUpYToTheLeftAndZooms) {
  const Json map = self_test_of({})["map"];
  const auto scale = [&map](const char* when) { return map[when]["left"].get<double>(); };
  for (const char* when : {"start", "wheel", "drag", "end"}) {
    EXPECT_GT(scale(when), 0.0) << when;  // points to the left by one metre of y
    EXPECT_NEAR(map[when]["up"], scale(when), 1e-6 * scale(when)) << when;
  }
  EXPECT_GT(scale("wheel"), 1.2 * scale("start"));
  EXPECT_NEAR(scale("drag"), scale("wheel"), 1e-6);
  // Dragged by 60 and 30 points to the right and down: what was there now is further by as much.
  const double moved_m =
      map["drag"]["middle"][0].get<double>() - map["wheel"]["middle"][0].get<double>();
  EXPECT_NEAR(moved_m, 60.0 / scale("drag"), 1e-6);
  const double up_m =
      map["drag"]["middle"][1].get<double>() - map["wheel"]["middle"][1].get<double>();
  EXPECT_NEAR(up_m, 30.0 / scale("drag"), 1e-6);
  EXPECT_NEAR(scale("end"), scale("start"), 1e-6);
}

// In both themes.
TEST_F(Browser, EveryTextHasContrastAndEveryControlANameAndAPlaceForTheKeyboard) {
  FixtureOptions options;
  options.absolute = true;
  const Json access = self_test_of({options, {"iterated", "graph"}})["access"];
  ASSERT_EQ(access.size(), 2u);
  for (const Json& theme : access) {
    EXPECT_EQ(theme["lang"], "en");
    EXPECT_NE(theme["title"], "");
    EXPECT_GT(theme["controls"], 20);
    EXPECT_GT(theme["texts"], 200);
    EXPECT_GT(theme["bars"], 2);
    for (const char* fault : {"unnamed", "unreachable", "faint"}) {
      EXPECT_EQ(theme[fault], Json::array()) << fault;
    }
  }
}

TEST_F(Browser, OneTrialWithoutGroundTruthOrLoopsIsNoError) {
  FixtureOptions options;
  options.trials = 1;
  options.separations.clear();
  options.noises.clear();
  options.ground_truth = false;
  options.loops = false;
  const Json result = self_test_of({options});
  ASSERT_FALSE(result.is_null());
  EXPECT_EQ(result["errors"], Json::array());
  EXPECT_GT(result["marks"].at("trajectories"), 0);
  EXPECT_FALSE(result["marks"].contains("sweep"));
  EXPECT_FALSE(result["marks"].contains("registrations"));
}

TEST_F(Browser, ShowsTheMosaicsWithTheirEstimatesAndWhereTheyDiffer) {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  EXPECT_EQ(self_test_of({options})["mosaics"]["hidden"], true);
  const Json result = self_test_of({options, {"iterated", "a&b_<c>%", "graph"}});
  EXPECT_EQ(result["errors"], Json::array());
  const Json& mosaics = result["mosaics"];
  EXPECT_EQ(mosaics["hidden"], false);
  ASSERT_EQ(mosaics["estimate"].size(), 3u);
  for (const Json& one : mosaics["estimate"]) {
    EXPECT_EQ(one["width"], 600);
    EXPECT_EQ(one["lines"], 3);  // a loop, the track, and white below it
  }
  EXPECT_THAT(mosaics["estimate"][2]["caption"].dump(), ::testing::HasSubstr("poses of "));
  EXPECT_EQ(mosaics["bare"]["lines"], 0);
  EXPECT_THAT(mosaics["estimate"][0]["caption"].dump(), ::testing::HasSubstr("twice, or blurred"));
  EXPECT_THAT(mosaics["estimate"][1]["caption"].dump(), ::testing::HasSubstr("breaks at a seam"));
  ASSERT_EQ(mosaics["difference"].size(), 2u);
  EXPECT_THAT(mosaics["difference"][0]["caption"].dump(),
              ::testing::HasSubstr("iterated in warm tones"));
  EXPECT_THAT(mosaics["difference"][0]["caption"].dump(),
              ::testing::HasSubstr("4.8 % of the 42 m² that both show differ by more than 16"));
}

}  // namespace
}  // namespace fathom::test
