// fathom select, on small synthetic stores.

#include <filesystem>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/core/files.hpp"
#include "harness/small_config.hpp"
#include "harness/small_study.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Select : public CommandLine {
 protected:
  // Two cells, five trials. Filter: error 0.08 and 0.09, 10 ms; graph: error 0.03, 30 ms. No two
  // differences of the times are equal, so that the p-value is the exact one.
  void store(const std::string& folder) const {
    StudyDescription study = described_study(std::string(kSmallSurvey) + R"(
report.title: small
trials: 5
estimators:
  - {type: trajectory_iekf, name: filter, max_iterations: 4}
  - {type: ceres_pose_graph, name: graph}
sweep:
  - {key: dataset.altitude.altimeter_sigma_m, name: altimeter, values: [0, 0.01]}
)");
    std::vector<RunRecord> runs;
    for (std::size_t cell = 0; cell < 2; ++cell) {
      for (std::size_t trial = 0; trial < 5; ++trial) {
        const double jitter = 0.001 * static_cast<double>(trial);
        const double worse = 0.01 * static_cast<double>(cell);
        runs.push_back(made_run("filter", cell, trial, 0.08 + worse + jitter, 10.0 + jitter));
        runs.push_back(
            made_run("graph", cell, trial, 0.03 + jitter, 30.0 + 3.0 * jitter + 0.03 * worse));
        runs.push_back(made_run(kDeadReckoning, cell, trial, 0.5 + jitter, 0.0));
      }
    }
    write_store(path(folder), study, runs);
  }
};

TEST_F(Select, NamesTheBackEndWithItsEvidenceAndAConfigurationThatRuns) {
  store("study");
  const Ended ended = fathom_done({"select", "study", "--require", "mean_position_error_m <= 0.1"});
  EXPECT_THAT(ended.out,
              StartsWith("filter meets the requirement in all 2 cells; least total_ms: 10.00 ["));
  EXPECT_THAT(ended.out,
              HasSubstr("better than graph (difference of total_ms -20.00 [-20.01, -20.00] "
                        "over 10 runs, Wilcoxon p 0.0020)"));
  EXPECT_THAT(ended.out, ContainsRegex("\nfilter +mean_position_error_m <= 0.1 +meets +0.09200 +"
                                       "\\[[^]]+\\] +altimeter 0.01 m\n"));
  EXPECT_THAT(ended.out, ContainsRegex("\ndead_reckoning +mean_position_error_m <= 0.1 +fails"));
  EXPECT_THAT(ended.out, ContainsRegex("\ngraph +30.01 +\\[30.00, 30.01\\] +10 +0 +meets all\n"));
  EXPECT_THAT(ended.out, ContainsRegex("\ndead_reckoning +- +- +10 +0 +baseline\n"));
  EXPECT_THAT(ended.out, HasSubstr("run it with: fathom run study/selected.yaml\n"));
  EXPECT_THAT(fathom_done({"check", "study/selected.yaml"}).out,
              AllOf(HasSubstr("configuration for 'run'"), HasSubstr("trajectory_iekf"),
                    HasSubstr("front_end.candidates.max_distance_m: 1.6\n")));
  fathom_done({"run", "study/selected.yaml", "--out", "run"});
  EXPECT_EQ(json_of("run/run.json").at("estimator").at("options").at("max_iterations"), "4");
}

TEST_F(Select, ATighterRequirementNamesAnother) {
  store("study");
  const Ended ended =
      fathom_done({"select", "study/results.sqlite", "--require", "mean_position_error_m<0.05",
                   "--where", "altimeter=0.01", "--out", "mine/deep"});
  EXPECT_THAT(ended.out, StartsWith("graph meets the requirement in the one cell; least total_ms"));
  EXPECT_THAT(read_file(path("mine/deep/selected.yaml")),
              AllOf(HasSubstr("type: ceres_pose_graph"),
                    HasSubstr("altitude.altimeter_sigma_m: 0.01  # swept in the study")));
  EXPECT_FALSE(fs::exists(path("study/selected.yaml")));
}

TEST_F(Select, NoneMeetsIsStatusOneWithTheRequirementAndTheNearest) {
  store("study");
  const Ended ended = fathom(
      {"select", "study", "--require", "mean_position_error_m<=0.01", "--require", "total_ms<=50"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, StartsWith("no back end meets all 2 requirements in all 2 cells: none "
                                    "meets mean_position_error_m <= 0.01; nearest is graph\n"));
  EXPECT_FALSE(fs::exists(path("study/selected.yaml")));
}

TEST_F(Select, AFailureIsSaidToBeWhatPutsABackEndOut) {
  RunRecord failed = made_run("filter", 0, 1, 0.01, 10.0);
  failed.outcome = "diverged";
  write_store(path("study"), described_study("trials: 2\nestimators: [{name: filter}]\n"),
              {made_run("filter", 0, 0, 0.01, 10.0), failed});
  const Arguments arguments{"select", "study", "--require", "total_ms<=50"};
  const Ended ended = fathom(arguments);
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out,
              AllOf(StartsWith("no back end meets the requirement in the one cell: failed runs put "
                               "out filter (--allow-failures); nearest is filter\n"),
                    HasSubstr("remark: filter: 1 of 2 runs failed and are left out of its means; "
                              "it is out for that\n")));
  Arguments lenient = arguments;
  lenient.insert(lenient.end(), {"--allow-failures", "0.5"});
  EXPECT_THAT(fathom_done(lenient).out, StartsWith("filter meets the requirement"));
}

TEST_F(Select, WithoutRequirementsTheObjectiveAlone) {
  store("study");
  EXPECT_THAT(fathom_done({"select", "study", "--maximise", "total_ms"}).out,
              StartsWith("graph is best over all 2 cells together; greatest total_ms: 30.01 ["));
  EXPECT_THAT(
      fathom_done({"select", "study", "--minimize", "mean_position_error_m"}).out,
      StartsWith(
          "graph is best over all 2 cells together; least mean_position_error_m: 0.03200 ["));
}

TEST_F(Select, QuietPrintsNothingAndWrites) {
  store("study");
  EXPECT_EQ(fathom_done({"select", "study", "--quiet"}).out, "");
  EXPECT_TRUE(fs::exists(path("study/selected.yaml")));
  const Ended none = fathom({"select", "study", "--quiet", "--require", "total_ms<1"});
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.out + none.err, "");
}

TEST_F(Select, BadInputIsRefusedWithWhatWouldBeRight) {
  store("study");
  write("photos/1.png", "");
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"select"}, "'results' is missing: "},
      {{"select", "nowhere"}, "there are no results; 'fathom compare' writes them"},
      {{"select", "photos"}, "has plain pictures"},
      {{"select", "study", "--require", "mean_positon_error_m<=0.1"},
       "did you mean 'mean_position_error_m'?"},
      {{"select", "study", "--require", "total_ms=3"},
       "for example 'mean_position_error_m <= 0.1'"},
      {{"select", "study", "--minimise", "totl_ms"}, "did you mean 'total_ms'?"},
      {{"select", "study", "--minimise", "anees"}, "neither more nor less of 'anees' is better"},
      {{"select", "study", "--minimise", "total_ms", "--maximise", "total_ms"}, "excludes"},
      {{"select", "study", "--where", "altimetre=0"}, "did you mean 'altimeter'?"},
      {{"select", "study", "--where", "altimeter=7"}, "altimeter is never '7'; there are 0, 0.01"},
      {{"select", "study", "--allow-failures", "1.5"}, "--allow-failures"},
      {{"select", "study", "--out", "study/results.sqlite"}, "is a file; --out takes"}};
  for (const auto& [arguments, message] : cases) {
    EXPECT_THAT(refusal(arguments), HasSubstr(message));
  }
}

TEST_F(Select, AReadOnlyFolderTakesAnOutFolder) {
  FATHOM_REQUIRE_NO_ROOT();
  store("study");
  fs::permissions(path("study"), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(refusal({"select", "study"}), HasSubstr("--out DIR says where selected.yaml"));
  fathom_done({"select", "study", "--out", "mine"});
  fs::permissions(path("study"), fs::perms::owner_all);
}

}  // namespace
}  // namespace fathom::test
