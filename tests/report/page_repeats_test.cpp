// What report.html makes of surveys and trials.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/report/study_report.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

// The data of the page of a made-up study.
Json data_of(const FixtureOptions& options) {
  const TemporaryFolder folder;
  write_fixture(folder / "study", options);
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  const std::string page = read_file(folder / "out" / "report.html");
  const std::string opening = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

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
    EXPECT_NEAR(keyframes["nees_interval"]["high"][7], interval.high, 1e-5);
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

}  // namespace
}  // namespace fathom::test
