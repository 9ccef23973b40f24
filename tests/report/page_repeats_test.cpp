// What report.html makes of surveys and trials.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/evaluation/consistency.hpp"
#include "report/page_data.hpp"
#include "report/study_fixture.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

TEST(PageRepeats, TheIntervalOfNeesCountsIndependentDraws) {
  FixtureOptions options;
  options.surveys = 3;
  options.trials = 2;
  const auto draws_of = [&options](const std::string& data_set) {
    options.data_set = data_set;
    const Json data = data_of(options);
    const Json& keyframes = data["cells"][0]["estimators"][1]["keyframes"];
    const int draws = keyframes["nees_draws"][7].get<int>();
    const Interval interval = anees_interval(static_cast<std::size_t>(draws), 3, 0.95);
    EXPECT_EQ(keyframes["nees_n"][7], 6);
    EXPECT_NEAR(data["cells"][0]["nees_interval"]["high"][6], interval.high, 1e-5);
    return draws;
  };
  EXPECT_EQ(draws_of("simulated"), 3);
  EXPECT_EQ(draws_of("simulated_log"), 6);
  options.surveys = 1;
  options.trials = 6;
  EXPECT_EQ(draws_of("image_folder"), 1);
  EXPECT_EQ(draws_of("simulated_log"), 6);
}

TEST(PageRepeats, SaysSurveysAndTrialsAndWhatTheyDoNotSpeakOf) {
  FixtureOptions options;
  options.trials = 2;
  const auto cell_of = [&options] { return data_of(options)["cells"][0]; };
  EXPECT_EQ(cell_of()["repeats"], "1 survey × 2 trials");
  EXPECT_THAT(cell_of()["limits"].get<std::string>(), HasSubstr("One survey: intervals over its"));
  EXPECT_EQ(cell_of()["paired"][0]["over"], "trials");
  options.surveys = 4;
  EXPECT_EQ(cell_of()["repeats"], "4 surveys × 2 trials");
  EXPECT_EQ(cell_of()["limits"], "");
  EXPECT_EQ(cell_of()["paired"][0]["over"], "surveys");
  EXPECT_EQ(cell_of()["paired"][0]["n"], 4);
  EXPECT_EQ(cell_of()["example"]["text"], "survey 0, trial 0");
  options.surveys = 1;
  options.data_set = "image_folder";
  EXPECT_EQ(cell_of()["repeats"], "one set of pictures, 2 trials");
  EXPECT_THAT(cell_of()["limits"].get<std::string>(), HasSubstr("One set of pictures: "));
}

// 30 000 loops of three estimators; those that were not used are few, and all of them are drawn.
TEST(PageRepeats, OfVeryManyLoopsSomeAreDrawn) {
  FixtureOptions options;
  options.trials = 1;
  options.keyframes = 10'010;
  options.separations = {"5"};
  options.noises.clear();
  const Json cell = data_of(options)["cells"][0];
  for (std::size_t e = 1; e < 4; ++e) {
    const Json& one = cell["example"]["estimators"][e];
    auto all = one["loops_in_all"].get<std::map<std::string, std::size_t>>();
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all["used"] + all["rejected"] + all["lost"], 10'000u);
    std::map<std::string, std::size_t> drawn;
    for (const Json& loop : one["loops"]) {
      EXPECT_EQ(loop.size(), 8u);  // with its ends
      ++drawn[loop[2].get<std::string>()];
    }
    EXPECT_EQ(drawn["rejected"], all["rejected"]);
    EXPECT_EQ(drawn["lost"], all["lost"]);
    EXPECT_LT(one["loops"].size(), 5'010u);
    EXPECT_GT(drawn["used"], 2'000u);
    EXPECT_LT(one["path"]["x_m"].size(), 6'010u);
  }
}

}  // namespace
}  // namespace fathom::test
