// report.html as a file: what it loads, and the data in it against the runs it was made from.

#include <cmath>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/evaluation/consistency.hpp"
#include "fathom/report/palette.hpp"
#include "report/page_data.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string fixture_page(const FixtureOptions& options = {}) {
  const TemporaryFolder folder;
  write_fixture(folder.path(), options);
  return page_of(ResultStore::open(folder.path()));
}

// The elements and attributes that make a browser fetch something.
TEST(ReportPage, LoadsNothing) {
  const std::string page = fixture_page();
  for (const char* pattern :
       {R"(<link\b)", R"(<(script|img|iframe|source|object|embed)\b[^>]*\b(src|data)\s*=)",
        R"(@import\b)", R"(url\(\s*['"]?(https?:)?//)",
        R"(\b(href|src)\s*=\s*['"]?(https?:)?//)"}) {
    std::smatch found;
    // The page's own text; Vega's lines are longer than a regular expression can take.
    std::string text;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);) {
      if (line.size() < 2000)
        text = line;
      else
        text = line.substr(0, 1000);
      EXPECT_FALSE(std::regex_search(text, found, std::regex(pattern))) << text;
    }
  }
  for (const char* remote :
       {"src=\"http", "href=\"http", "url(http", "//cdn", "jsdelivr", "unpkg"}) {
    EXPECT_EQ(page.find(remote), std::string::npos) << remote;
  }
}

TEST(ReportPage, NamesAreEscaped) {
  const std::string page = fixture_page();
  EXPECT_THAT(page, HasSubstr("<title>Loops &amp; &lt;noise&gt;: 50 % of a_b &lt;/script&gt;"
                              "</title>"));
  EXPECT_EQ(element_of(page, "data").find('<'), std::string::npos);
  const Json data = data_of_page(page);
  EXPECT_EQ(data["title"], "Loops & <noise>: 50 % of a_b </script>");
  EXPECT_EQ(data["estimators"][2]["name"], "a&b_<c>%");
  EXPECT_EQ(data["configuration"]["dataset.path"], "a,b \"c\" <d>");
  EXPECT_EQ(data["manifests"][0]["machine"]["cpu"], "<Two> & a half");
}

TEST(ReportPage, AnEstimatorHasTheColourOfItsTypeAndNoneTheSame) {
  const Json estimators = data_of_page(fixture_page())["estimators"];
  EXPECT_EQ(estimators[0]["colour"], "#8a8a8a");
  EXPECT_EQ(estimators[1]["colour"], "#0072b2");
  EXPECT_EQ(estimators[2]["colour"], "#d55e00");
  EXPECT_EQ(estimators[3]["colour"], "#009e73");
}

// By their places, whatever their names and types.
TEST(ReportPage, EveryEstimatorHasTheLineOfItsPlace) {
  const TemporaryFolder folder;
  StudyDescription study;
  for (int i = 0; i < 20; ++i) study.estimators.push_back({"e" + std::to_string(i), "ekf"});
  ResultStore store = ResultStore::write(folder.path(), study, "no JSON");
  RunRecord run;
  run.key = {0, 0, 0, "e0"};
  run.outcome = "converged";
  store.add(run);
  store.finish();
  const Json data = data_of_page(page_of(ResultStore::open(folder.path())));
  ASSERT_EQ(data["estimators"].size(), 21u);
  EXPECT_EQ(data["estimators"][0]["colour"], hex(dead_reckoning_style().colour));
  for (std::size_t place = 0; place < 20; ++place) {
    const Json& one = data["estimators"][place + 1];
    EXPECT_EQ(one["colour"], hex(estimator_style(place).colour)) << place;
    EXPECT_EQ(one["dashes"], Json(estimator_style(place).dashes)) << place;
  }
  EXPECT_EQ(data["manifests"][0], "no JSON");
}

TEST(ReportPage, MetricsSayTheirUnitAndWhatIsBetter) {
  const Json metrics = data_of_page(fixture_page())["metrics"];
  const auto metric = [](const char* label, const char* title, const char* unit, bool cost,
                         const char* better) {
    return Json{
        {"label", label}, {"title", title}, {"unit", unit}, {"cost", cost}, {"better", better}};
  };
  EXPECT_EQ(metrics["mean_position_error_m"],
            metric("mean position error (m)", "mean position error", "m", false, "lower"));
  EXPECT_EQ(metrics["total_ms"],
            metric("estimate, time (ms)", "estimate, time", "ms", true, "lower"));
  EXPECT_EQ(metrics["anees"], metric("ANEES", "ANEES", "", false, "neither"));
}

TEST(ReportPage, EveryCellHasItsAlignment) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.trials = 1;
  options.alignments = {"origin", "none"};
  write_fixture(folder.path(), options);
  const Json data = data_of_page(page_of(ResultStore::open(folder.path())));
  ASSERT_EQ(data["cells"].size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const std::string expected = i % 2 == 0 ? "origin" : "none";
    EXPECT_EQ(data["cells"][i]["alignment"], expected);
    EXPECT_THAT(data["cells"][i]["caption"].get<std::string>(), HasSubstr("alignment " + expected));
  }
}

// Means and roots over the trials, taken here from the store's series one keyframe at a time.
TEST(ReportPage, KeyframeStatisticsAreThoseOfTheRunsDone) {
  const TemporaryFolder folder;
  write_fixture(folder.path());
  const ResultStore store = ResultStore::open(folder.path());
  const Json cell = data_of_page(page_of(store))["cells"][5];
  const Json& one = cell["estimators"][2];
  ASSERT_EQ(one["name"], "a&b_<c>%");
  EXPECT_EQ(one["runs"], 6);
  EXPECT_EQ(one["done"], 4);
  for (const std::size_t k : {std::size_t{1}, std::size_t{17}, std::size_t{39}}) {
    double sum = 0.0;
    double squares = 0.0;
    double stated = 0.0;
    double nees = 0.0;
    for (std::size_t trial = 2; trial < 6; ++trial) {  // 0 and 1 failed
      const RunKey key{5, 0, trial, "a&b_<c>%"};
      const double error = store.series(key, "position_error_m")->at(k);
      sum += error;
      squares += error * error;
      stated +=
          2.0 * std::sqrt(store.series(key, "cov_xx")->at(k) + store.series(key, "cov_yy")->at(k));
      nees += store.series(key, "pose_nees")->at(k - 1);
    }
    const Json& keyframes = one["keyframes"];
    EXPECT_EQ(keyframes["keyframe"][k], k);
    EXPECT_EQ(keyframes["n"][k], 4);
    EXPECT_NEAR(keyframes["mean_m"][k], sum / 4.0, 1e-5 * sum);
    const double sd = std::sqrt((squares - sum * sum / 4.0) / 3.0);
    EXPECT_NEAR(keyframes["low_m"][k], std::max(0.0, sum / 4.0 - 2.0 * sd), 1e-4 * sum);
    EXPECT_NEAR(keyframes["high_m"][k], sum / 4.0 + 2.0 * sd, 1e-4 * sum);
    EXPECT_NEAR(keyframes["empirical_m"][k], 2.0 * std::sqrt(squares / 4.0), 1e-5 * sum);
    EXPECT_NEAR(keyframes["estimated_m"][k], stated / 4.0, 1e-5 * stated);
    EXPECT_NEAR(keyframes["anees"][k], nees / 12.0, 1e-5 * nees);
    // Of one survey: its trials share the errors of its registrations.
    EXPECT_EQ(keyframes["nees_n"][k], 4);
    EXPECT_EQ(keyframes["nees_draws"][k], 1);
    const Interval interval = anees_interval(1, 3, 0.95);
    EXPECT_EQ(cell["nees_interval"]["keyframe"][k - 1], k);
    EXPECT_NEAR(cell["nees_interval"]["low"][k - 1], interval.low, 1e-5);
    EXPECT_NEAR(cell["nees_interval"]["high"][k - 1], interval.high, 1e-5);
  }
  EXPECT_EQ(cell["nees_interval"]["draws"], 1);
  EXPECT_TRUE(one["keyframes"]["anees"][0].is_null());
}

TEST(ReportPage, TheExampleIsTheLowestTrialAlone) {
  const TemporaryFolder folder;
  write_fixture(folder.path());
  const ResultStore store = ResultStore::open(folder.path());
  const Json example = data_of_page(page_of(store))["cells"][0]["example"];
  EXPECT_EQ(example["trial"], 0);
  EXPECT_EQ(example["truth"]["x_m"].size(), 40u);
  ASSERT_EQ(example["estimators"].size(), 4u);
  const Json& one = example["estimators"][1];
  const RunKey key{0, 0, 0, "iterated"};
  EXPECT_NEAR(one["path"]["x_m"][12], store.series(key, "x_m")->at(12), 1e-4);
  ASSERT_EQ(one["loops"].size(), 30u);
  const Json& loop = one["loops"][3];
  ASSERT_EQ(loop.size(), 8u);
  EXPECT_EQ(loop[0], 6);
  EXPECT_EQ(loop[1], 13);
  EXPECT_EQ(loop[2], "rejected");
  EXPECT_TRUE(loop[3].is_null());  // −1 in the store: no NIS
  EXPECT_NEAR(loop[4], store.series(key, "x_m")->at(6), 1e-4);
  EXPECT_NEAR(loop[7], store.series(key, "y_m")->at(13), 1e-4);
}

TEST(ReportPage, WhatIsNotKnownIsLeftOut) {
  FixtureOptions options;
  options.ground_truth = false;
  options.loops = false;
  options.noises.clear();
  const Json data = data_of_page(fixture_page(options));
  EXPECT_FALSE(data["metrics"].contains("anees"));
  const Json& cell = data["cells"][0];
  EXPECT_TRUE(cell["example"]["truth"].is_null());
  for (const Json& one : cell["estimators"]) {
    EXPECT_FALSE(one.contains("bounds"));
    EXPECT_THAT(one["updates"]["keyframe"], IsEmpty());
  }
}

TEST(ReportPage, StaysSmallOverManyCellsTrialsAndKeyframes) {
  FixtureOptions options;
  options.trials = 2;
  options.keyframes = 120;
  options.separations = {"1", "2", "3", "4", "5"};
  options.noises = {"a", "b", "c", "d"};
  const std::string page = fixture_page(options);
  const Json data = data_of_page(page);
  ASSERT_EQ(data["cells"].size(), 20u);
  EXPECT_EQ(data["cells"][19]["estimators"][1]["keyframes"]["keyframe"].size(), 120u);
  EXPECT_LT(page.size(), 6000000u);
}

TEST(ReportPage, LongRunsAreThinnedToTheirFirstAndLastKeyframe) {
  FixtureOptions options;
  options.trials = 1;
  options.keyframes = 30000;
  options.separations.clear();
  options.noises.clear();
  options.loops = false;
  const std::string page = fixture_page(options);
  const Json keyframes = data_of_page(page)["cells"][0]["estimators"][1]["keyframes"]["keyframe"];
  EXPECT_EQ(keyframes.front(), 0);
  EXPECT_EQ(keyframes.back(), 29999);
  EXPECT_LT(page.size(), 6000000u);
}

}  // namespace
}  // namespace fathom::test
