// Fixes and headings in report.html: its data, and its map in a real browser.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "report/browser_page.hpp"
#include "report/page_data.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;

FixtureOptions with_absolute(bool is_old = false) {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  options.absolute = true;
  options.absolute_is_old = is_old;
  return options;
}

// The estimators of the example on the page of a store.
Json estimators_of(const ResultStore& store) {
  return data_of_page(page_of(store))["cells"][0]["example"]["estimators"];
}

Json estimators_of(const FixtureOptions& options) {
  const TemporaryFolder folder;
  write_fixture(folder.path(), options);
  return estimators_of(ResultStore::open(folder.path()));
}

const Json& entry_of(const Json& absolute, std::size_t keyframe, const char* part) {
  for (const Json& one : absolute) {
    if (one["keyframe"] == keyframe && one.contains(part)) return one;
  }
  ADD_FAILURE() << keyframe << " has no " << part;
  return absolute.front();
}

TEST(PageAbsolute, TheExampleHasItsAbsoluteMeasurements) {
  const TemporaryFolder folder;
  write_fixture(folder.path(), with_absolute());
  const ResultStore store = ResultStore::open(folder.path());
  const Json estimators = estimators_of(store);
  EXPECT_EQ(estimators[0]["absolute"], Json::array());  // dead reckoning
  const Json& gated = estimators[1];
  EXPECT_EQ(gated["absolute"].size(), 48u);
  EXPECT_EQ(gated["absolute_in_all"], Json::parse(R"({"fixes": [7, 1], "headings": [39, 1]})"));
  const Json& fix = entry_of(gated["absolute"], 20, "fix_m");
  EXPECT_EQ(fix["fix_m"], Json::parse("[2, 2.6]"));  // of (0, 1.6)
  EXPECT_EQ(fix["fix_sigma_m"], Json::parse("[0.5, 0.25]"));
  EXPECT_EQ(fix["fate"], "rejected");
  EXPECT_EQ(fix["left_out"], true);
  EXPECT_NEAR(fix["off_m"],
              std::hypot(fix["at_m"][0].get<double>() - 2.0, fix["at_m"][1].get<double>() - 2.6),
              1e-4);
  EXPECT_EQ(fix["weight"], 0);
  EXPECT_EQ(fix["nis"], 400);
  EXPECT_FALSE(fix.contains("heading_rad"));
  const RunKey key{0, 0, 0, "iterated"};
  EXPECT_NEAR(fix["at_m"][0], store.series(key, "x_m")->at(20), 1e-4);
  EXPECT_NEAR(fix["at_m"][1], store.series(key, "y_m")->at(20), 1e-4);
  const Json& heading = entry_of(gated["absolute"], 12, "heading_rad");
  EXPECT_NEAR(heading["heading_rad"], 3.0 + 0.5 * M_PI, 1e-4);
  EXPECT_EQ(heading["sigma_rad"], 0.1);
  EXPECT_EQ(heading["fate"], "rejected");
  EXPECT_FALSE(heading.contains("fix_m"));
  // A loss leaves out what it weighs little; no estimator that has no NIS says one.
  const Json& weak = entry_of(estimators[3]["absolute"], 20, "fix_m");
  EXPECT_EQ(weak["fate"], "used");
  EXPECT_EQ(weak["left_out"], true);
  EXPECT_EQ(weak["weight"], 0.1);
  EXPECT_FALSE(weak.contains("nis"));
  EXPECT_EQ(estimators[3]["absolute_in_all"]["fixes"], Json::parse("[7, 1]"));
  EXPECT_EQ(estimators[2]["absolute_in_all"]["fixes"], Json::parse("[8, 0]"));
}

// What was left out is never thinned away by the many that were used.
TEST(PageAbsolute, ManyHeadingsAreThinned) {
  FixtureOptions options = with_absolute();
  options.trials = 1;
  options.keyframes = 3000;
  options.loops = false;
  const Json one = estimators_of(options)[1];
  EXPECT_EQ(one["absolute_in_all"], Json::parse(R"({"fixes": [599, 1], "headings": [2999, 1]})"));
  EXPECT_LT(one["absolute"].size(), 220u);
  EXPECT_EQ(entry_of(one["absolute"], 20, "fix_m")["weight"], 0);
  EXPECT_EQ(entry_of(one["absolute"], 12, "heading_rad")["weight"], 0);
}

TEST(PageAbsolute, AStoreWithoutWhatWasMeasuredHasNoMarks) {
  for (const Json& one : estimators_of(with_absolute(true))) {
    EXPECT_EQ(one["absolute"], Json::array());
    EXPECT_EQ(one["absolute_in_all"]["fixes"], Json::parse("[0, 0]"));
  }
}

const Json* with_tooltip(const Json& marks, const std::string& begin) {
  for (const Json& one : marks) {
    if (one["tooltip"].get<std::string>().starts_with(begin)) return &one;
  }
  return nullptr;
}

// The fixture's: of keyframe 20 a fix at (2, 2.6), which two estimators leave out; headings of 0 on
// the first line; of keyframe 12 one of 3 + π/2, which they leave out, too.
TEST_F(Browser, TheMapShowsFixesAndHeadingsAndWhatWasLeftOut) {
  const Json result = self_test_of({with_absolute()});
  ASSERT_FALSE(result.is_null());
  EXPECT_EQ(result["errors"], Json::array());
  const Json& absolute = result["absolute"];
  ASSERT_EQ(absolute["fixes"].size(), 8u);  // three estimators have them at one place
  EXPECT_EQ(absolute["links"].size(), 24u);
  const Json* jump = with_tooltip(absolute["fixes"], "Fix of keyframe 20, σ 500 mm and 250 mm");
  ASSERT_NE(jump, nullptr) << absolute["fixes"].dump();
  EXPECT_NEAR((*jump)["x"], 2.0, 1e-3);
  EXPECT_NEAR((*jump)["y"], 2.6, 1e-3);
  EXPECT_EQ((*jump)["isRed"], true);
  EXPECT_EQ((*jump)["isRing"], false);
  for (const char* words : {"iterated: rejected by the gate, NIS 400", "a&b_<c>%: used, NIS 400, ",
                            "graph: used with a weight of 0.100, "}) {
    EXPECT_THAT((*jump)["tooltip"], ::testing::HasSubstr(words));
  }
  const Json* kept = with_tooltip(absolute["fixes"], "Fix of keyframe 5,");
  ASSERT_NE(kept, nullptr);
  EXPECT_NEAR((*kept)["x"], 5.0, 1e-3);
  EXPECT_NEAR((*kept)["y"], 0.0, 1e-3);
  EXPECT_EQ((*kept)["isRed"], false);
  EXPECT_EQ((*kept)["isRing"], true);
  ASSERT_EQ(absolute["headings"].size(), 120u);
  EXPECT_EQ(absolute["bars"], 2);
  const Json* ahead = with_tooltip(absolute["headings"], "Heading of keyframe 4, 0°, σ 5.73°");
  ASSERT_NE(ahead, nullptr) << absolute["headings"].dump();
  EXPECT_NEAR((*ahead)["right"], 0.0, 1e-6);
  EXPECT_LT((*ahead)["down"], -10.0);
  EXPECT_EQ((*ahead)["isRed"], false);
  const Json* wrong = with_tooltip(absolute["headings"], "Heading of keyframe 12, ");
  ASSERT_NE(wrong, nullptr);
  const double theta = 3.0 + 0.5 * M_PI;
  const double right = (*wrong)["right"];
  const double down = (*wrong)["down"];
  EXPECT_NEAR(right / std::hypot(right, down), -std::sin(theta), 1e-4);
  EXPECT_NEAR(down / std::hypot(right, down), -std::cos(theta), 1e-4);
  EXPECT_THAT(absolute["caption"].dump(),
              ::testing::HasSubstr("Fixes left out: iterated 1 of 8, graph 1 of 8. Headings left "
                                   "out: iterated 1 of 40, graph 1 of 40."));
  // All layers, and without ellipses, loops, and marks.
  ASSERT_EQ(result["layers"].size(), 4u);
  EXPECT_LE(result["layers"][3].get<int>() + 8 + 24 + 120 + 2, result["layers"][0].get<int>());
}

TEST_F(Browser, AMapWithoutAbsoluteMeasurementsSaysNothingOfThem) {
  const Json result = self_test_of({with_absolute(true)});
  ASSERT_FALSE(result.is_null());
  EXPECT_EQ(result["errors"], Json::array());
  EXPECT_EQ(result["layers"].size(), 3u);
  EXPECT_EQ(result["absolute"]["fixes"], Json::array());
  EXPECT_THAT(result["absolute"]["caption"].dump(), ::testing::Not(::testing::HasSubstr("ix")));
}

}  // namespace
}  // namespace fathom::test
