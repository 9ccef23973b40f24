// What the page in a real browser says and writes: numbers, captions, titles, tables.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/report/table.hpp"
#include "report/browser_page.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Browser, NumbersAreRoundedAsInTables) {
  const Json numbers = self_test_of({})["digits"];
  ASSERT_GT(numbers.size(), 15u);
  for (const Json& one : numbers) {
    const double value = one[0];
    std::string text = format_number(value, 3);
    if (text == "1.00e+07") text = "1.00 × 10⁷";
    EXPECT_EQ(one[1], text) << value;
  }
}

TEST_F(Browser, APowerOfTenIsSaidOfAnIntervalToo) {
  const Json interval = self_test_of({})["interval"];
  EXPECT_EQ(interval["text"], "(1.70 [-0.0487, 9.17]) × 10⁶");
  EXPECT_EQ(interval["parts"], Json({"1.70 × 10⁶", "[-0.0487, 9.17] × 10⁶"}));
}

// In the first cell measurements do not fit each other.
TEST_F(Browser, RingsNobodyByWhatDoesNotRank) {
  FixtureOptions options;
  options.misfit = true;
  const Json by_error = self_test_of({options})["captions"];
  EXPECT_THAT(by_error["pareto"].dump(), HasSubstr("Ringed, on the dashed line"));
  EXPECT_THAT(by_error["regimes"].dump(), HasSubstr("Mean position error over that of the best"));
  options.ground_truth = false;
  const Json by_f = self_test_of({options})["captions"];
  EXPECT_THAT(by_f["pareto"].dump(), HasSubstr("None is ringed: where measurements do not fit"));
  EXPECT_THAT(by_f["regimes"].dump(), HasSubstr("No best one is shown: where measurements"));
  EXPECT_THAT(by_f["regimes"].dump(), Not(HasSubstr("over that of the best")));
}

// The axis upwards has two places.
TEST_F(Browser, TitlesOfAxesAreWhole) {
  FixtureOptions options;
  options.noise_name = "standard deviation of the heading of odometry";
  EXPECT_EQ(self_test_of({options})["cut"], Json::array());
}

// Of a sweep, numbers or words, on a phone.
TEST_F(Browser, NoPlaceOfASweepIsWithoutItsLabel) {
  FixtureOptions numbers;
  numbers.separations = {"10", "20", "30", "40", "50", "60", "70", "80", "90", "100"};
  numbers.noises.clear();
  FixtureOptions crowded = numbers;  // near zero, where two labels have no room for a third
  crowded.separations = {"0", "0.002", "0.005", "0.01", "0.02", "0.05", "0.1"};
  FixtureOptions geometric = crowded;
  geometric.separations.erase(geometric.separations.begin());
  FixtureOptions words;
  words.separations.clear();
  words.noises = {"independent", "altimeter_scale", "altimeter_offset", "tilt", "tilt_and_scale"};
  for (const FixtureOptions& options : {numbers, crowded, geometric, words}) {
    const Json answer = self_test_of({options, {}, 420})["answer"];
    const Json ticks = answer["ticks"];
    ASSERT_FALSE(ticks.empty());
    EXPECT_EQ(answer["crossed"], Json::array());
    const char* scale = options == geometric ? "log" : options == words ? "point" : "linear";
    for (const Json& one : answer["sweepScales"]) EXPECT_EQ(one, scale);
    const auto& labels = options.noises.empty() ? options.separations : options.noises;
    for (const Json& plot : ticks) EXPECT_EQ(plot, Json(labels));
  }
}

// A table takes the width; in a narrow box it scrolls, says so, and keeps the names of its rows.
TEST_F(Browser, TablesTakeTheWidthAndSayThatTheyScroll) {
  FixtureOptions one_cell;
  one_cell.separations.clear();
  one_cell.noises.clear();
  for (const FixtureOptions& options : {FixtureOptions{}, one_cell}) {
    const Json boxes = self_test_of({options})["boxes"];
    ASSERT_EQ(boxes.size(), 2u);
    for (const Json& box : boxes) {
      EXPECT_NEAR(box["share"], 1.0, 0.01);
      EXPECT_EQ(box["wide"]["hint"], "none");
      EXPECT_EQ(box["wide"]["tabIndex"], -1);
      EXPECT_THAT(box["narrow"]["hint"].dump(), HasSubstr("scroll sideways"));
      EXPECT_EQ(box["narrow"]["tabIndex"], 0);
      EXPECT_GT(box["narrow"]["scrolled"], 0);
      EXPECT_EQ(box["narrow"]["cut"], 0);
      EXPECT_NEAR(box["narrow"]["name"], 0.0, 0.5);
      EXPECT_THAT(box["low"]["hint"].dump(), HasSubstr("scroll down"));
      EXPECT_EQ(box["low"]["tabIndex"], 0);
    }
  }
}

TEST_F(Browser, OnATelephoneTheSwitchesAreAllSeenAndScrollAway) {
  const Json result = self_test_of({.width = 500});
  EXPECT_LE(result["bar"]["cut"], 0);
  EXPECT_EQ(result["bar"]["position"], "static");
  EXPECT_LE(result["beyond"], 0);
  EXPECT_EQ(self_test_of({})["bar"]["position"], "sticky");
}

}  // namespace
}  // namespace fathom::test
