// Studies of several surveys through the real command line.

#include <csignal>
#include <random>
#include <set>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/study_content.hpp"
#include "fathom/core/files.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Surveys : public CommandLine {
 protected:
  Arguments compare(const std::string& out, int surveys, int trials, const Arguments& more = {}) {
    Arguments all{"compare",    "s.yaml",
                  "--out",      out,
                  "--surveys",  std::to_string(surveys),
                  "--trials",   std::to_string(trials),
                  "--no-mosaic"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(Surveys, SurveyZeroIsAStudyOfOneSurvey) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "one", "--trials", "2", "--no-cache", "--no-mosaic"});
  fathom_done(compare("three", 3, 2, {"--no-cache", "--jobs", "2"}));
  EXPECT_EQ(content(path("one")), content(path("three"), 1));
  EXPECT_NE(content(path("three"), 1), content(path("three")));
  // Every survey and trial of a cell has a log of its own.
  std::set<std::string> logs;
  std::size_t trials = 0;
  for (const RunRecord& run : ResultStore::open(path("three")).runs()) {
    if (run.key.estimator != "ekf") continue;
    logs.insert(run.log_hash);
    ++trials;
  }
  EXPECT_EQ(trials, 2u * 3u * 2u);
  EXPECT_EQ(logs.size(), trials);
}

TEST_F(Surveys, MoreSurveysAndTrialsAreAddedToWhatIsThere) {
  write("s.yaml", kStudy);
  fathom_done(compare("out", 1, 2, {"--cache", "cache"}));
  fathom_done(compare("out", 3, 2, {"--cache", "cache"}));
  fathom_done(compare("out", 3, 3, {"--cache", "cache"}));
  fathom_done(compare("other", 3, 3, {"--cache", "cache"}));
  EXPECT_EQ(content(path("out")), content(path("other")));
  EXPECT_EQ(ResultStore::open(path("out")).study().surveys, 3u);
}

TEST_F(Surveys, KilledAgainAndAgainItEndsAsAnUndisturbedOneDoes) {
  if (std::string(FATHOM_TEST_PRELOADED).empty()) GTEST_SKIP() << "not with a sanitizer";
  write("s.yaml", kStudy);
  fathom_done(compare("whole", 3, 4, {"--cache", "a"}));
  std::mt19937 random(3);
  for (int i = 0; i < 5; ++i) {
    surroundings_.environment = {{"LD_PRELOAD", FATHOM_TEST_PRELOADED},
                                 {"FATHOM_KILL_AT_WRITE", std::to_string(20 + random() % 60)}};
    EXPECT_EQ(fathom(compare("killed", 3, 4, {"--cache", "b", "--jobs", "2"})).status,
              128 + SIGKILL);
  }
  surroundings_ = {};
  fathom_done(compare("killed", 3, 4, {"--cache", "b", "--jobs", "2"}));
  EXPECT_EQ(content(path("whole")), content(path("killed")));
}

TEST_F(Surveys, EveryOutputSaysSurveysAndTrials) {
  write("s.yaml", kStudy);
  const std::string table = fathom_done(compare("out", 2, 2)).out;
  EXPECT_THAT(table, HasSubstr("alignment origin, 2 surveys × 2 trials, jobs 1"));
  EXPECT_THAT(table, Not(HasSubstr("One survey")));
  EXPECT_THAT(table, HasSubstr(" 2 surveys "));  // of the paired tests
  EXPECT_THAT(read_file(path("out/tables.tex")), HasSubstr("2 surveys $\\times$ 2 trials"));
  EXPECT_THAT(read_file(path("out/report.html")), HasSubstr("2 surveys × 2 trials"));
  EXPECT_THAT(read_file(path("out/runs.csv")), HasSubstr(",survey,trial,estimator,"));
  EXPECT_THAT(read_file(path("out/summary.csv")), HasSubstr(",surveys,n,failures,"));
  const std::string selected = fathom_done({"select", "out", "--minimise", "ate_rmse_m"}).out;
  EXPECT_THAT(selected, HasSubstr("evidence in each cell: 2 surveys × 2 trials\n"));
  EXPECT_THAT(selected, HasSubstr(" over 2 surveys"));
  EXPECT_THAT(read_file(path("out/selected.yaml")), HasSubstr("each 2 surveys × 2 trials"));
  EXPECT_THAT(fathom_done({"check", "s.yaml"}).out, HasSubstr("2 cells, each 1 survey × 5 trials"));
}

TEST_F(Surveys, RealPicturesAreOneSet) {
  write("s.yaml", kStudy);
  fathom_done({"simulate", "s.yaml", "--out", "data"});
  const std::string folder =
      "dataset: {type: image_folder, path: data, added_noise: {sigma_x_m: 0.01, sigma_y_m: 0.01, "
      "sigma_theta_rad: 0.01}}\nfront_end: {keyframes: {separation_frames: 3}}\n"
      "estimators: [{type: ekf}, {type: trajectory_iekf}]\ntrials: 2\n";
  write("f.yaml", folder);
  const std::string table =
      fathom_done({"compare", "f.yaml", "--out", "out", "--no-mosaic", "--no-cache"}).out;
  EXPECT_THAT(table, HasSubstr("one set of pictures, 2 trials"));
  EXPECT_THAT(table, HasSubstr("One set of pictures: intervals over its trials say nothing of"));
  EXPECT_THAT(refusal({"compare", "f.yaml", "--out", "no", "--surveys", "2"}),
              StartsWith("--surveys: an image_folder is one set of pictures"));
  write("g.yaml", folder + "surveys: 3\n");
  EXPECT_THAT(refusal({"compare", "g.yaml", "--out", "no"}), StartsWith("g.yaml:5: surveys: an "));
}

TEST_F(Surveys, ContradictoryAndAbsurdNumbersAreRefused) {
  write("log.yaml", "dataset: {type: simulated_log}\nestimators: [{type: ekf}]\nsurveys: 2\n");
  EXPECT_THAT(refusal({"compare", "log.yaml", "--out", "no"}),
              StartsWith("log.yaml:3: surveys: simulated_log draws everything in each of its"));
  write("s.yaml", kStudy);
  EXPECT_THAT(refusal(compare("no", 300'000, 5)),
              StartsWith("--surveys: 300000 of 5 trials each are too many"));
  EXPECT_THAT(refusal(compare("no", 0, 5)), StartsWith("--surveys: expected"));
  EXPECT_THAT(refusal({"run", "s.yaml", "--out", "no", "--set", "surveys=2"}),
              HasSubstr("it is for 'compare'"));
}

}  // namespace
}  // namespace fathom::test
