// No command writes over what it reads, by whatever path.

#include "fathom/workflow/inputs.hpp"

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Inputs : public CommandLine {
 protected:
  /// The command must refuse to write over this file, and leave it as it was.
  void expect_kept(const std::string& input, const Arguments& arguments) const {
    const std::string before = read_file(path(input));
    EXPECT_THAT(refusal(arguments), HasSubstr("would replace ")) << arguments[0];
    EXPECT_EQ(read_file(path(input)), before) << arguments[0];
  }
};

const std::string kTruth = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n";

TEST_F(Inputs, FoldersThatDifferHaveRunsOfOtherNames) {
  for (const char* folder : {"dive.1", "dive.2", "a/mav0", "b/mav0"}) {
    std::filesystem::create_directories(path(folder));
  }
  const auto name = [this](const std::string& of) { return workflow::stem_of(path(of)); };
  EXPECT_EQ(name("dive.1"), "dive.1");
  EXPECT_EQ(name("dive.2/"), "dive.2");
  EXPECT_EQ(name("a/mav0"), "a");
  EXPECT_EQ(name("b/mav0/"), "b");
  EXPECT_EQ(name("study.1.yaml"), "study.1");
  EXPECT_EQ(workflow::stem_of(""), "run");
}

TEST_F(Inputs, SpoilKeepsItsGraph) {
  write("g.g2o", square_graph(200, 10));
  fs::create_directory(path("sub"));
  fs::create_symlink("g.g2o", path("soft.g2o"));
  fs::create_hard_link(path("g.g2o"), path("hard.g2o"));
  for (const std::string out : {"g.g2o", "./sub/../g.g2o", "soft.g2o", "hard.g2o"}) {
    expect_kept("g.g2o", {"spoil", "g.g2o", "--out", out});
    expect_kept("g.g2o", {"spoil", out, "--out", "g.g2o"});
  }
  // The list of false loops lies beside the graph.
  write("x.false_loops.csv", kTruth);
  expect_kept("x.false_loops.csv",
              {"spoil", "g.g2o", "--ground-truth", "x.false_loops.csv", "--out", "x.g2o"});
}

TEST_F(Inputs, SolveKeepsItsGraphAndItsTruth) {
  write("out/measurements.g2o", kTwoPoses);
  expect_kept("out/measurements.g2o", {"solve", "out/measurements.g2o", "--out", "out"});
  write("g.g2o", kTwoPoses);
  write("out/ground_truth.tum", kTruth);
  expect_kept("out/ground_truth.tum",
              {"solve", "g.g2o", "--ground-truth", "out/ground_truth.tum", "--out", "out"});
}

TEST_F(Inputs, SimulateKeepsItsConfigurationAndItsFloor) {
  write("data/run.yaml", kSmallSurvey);
  expect_kept("data/run.yaml", {"simulate", "data/run.yaml", "--out", "data"});
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "survey"});
  const std::string floor = "survey/mav0/cam0/data/0.png";
  expect_kept(floor,
              {"simulate", "c.yaml", "--out", "survey", "--set", "dataset.world.picture=" + floor});
}

// What a vehicle has recorded cannot be made again, what 'simulate' made can.
TEST_F(Inputs, SimulateKeepsASurveyThatItDidNotMake) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "survey"});
  fathom_done({"simulate", "c.yaml", "--out", "survey"});
  for (const char* body : {"", "comment: reef, dive 3\n"}) {
    fs::remove(path("survey/mav0/body.yaml"));
    if (*body != '\0') write("survey/mav0/body.yaml", body);
    const std::string picture = read_file(path("survey/mav0/cam0/data/0.png"));
    EXPECT_THAT(refusal({"simulate", "c.yaml", "--out", "survey", "--seed", "8"}),
                HasSubstr("survey/mav0: is not of 'simulate', which would replace it"));
    EXPECT_EQ(read_file(path("survey/mav0/cam0/data/0.png")), picture);
  }
}

TEST_F(Inputs, RunKeepsItsConfiguration) {
  write("out/metrics.json", kSmallSurvey);
  expect_kept("out/metrics.json", {"run", "out/metrics.json", "--out", "out"});
}

TEST_F(Inputs, CompareKeepsItsConfigurationAndSaysSoAtOnce) {
  const std::string study = std::string(kSmallSurvey) + "estimators: [{type: ekf}]\ntrials: 1\n";
  for (const std::string config : {"out/ekf/study.yaml", "out/table.txt", "out/figures/s.yaml"}) {
    write(config, study);
    expect_kept(config, {"compare", config, "--out", "out", "--no-cache"});
  }
}

// A study of pictures with a mask has none of its own in its folder, and removes older ones.
TEST_F(Inputs, CompareKeepsItsMask) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  fs::create_directory(path("out"));
  fs::copy(path("data/mav0/cam0/data/0.png"), path("out/mask.png"));
  write("p.yaml", R"(
dataset: {type: pictures, path: data/mav0/cam0/data, mask: out/mask.png, altitude_m: 2,
          camera: {focal_px: 150}}
estimators: [{type: ekf}]
)");
  expect_kept("out/mask.png", {"compare", "p.yaml", "--out", "out", "--no-cache"});
}

TEST_F(Inputs, RegisterKeepsItsPictures) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  fs::create_directory(path("out"));
  for (const std::string name : {"overlay.png", "matches_raw.png"}) {
    fs::copy(path("data/mav0/cam0/data/0.png"), path("out/" + name));
    expect_kept("out/" + name,
                {"register", "out/" + name, "data/mav0/cam0/data/500000000.png", "--config",
                 "c.yaml", "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"});
  }
}

TEST_F(Inputs, MosaicKeepsItsTrajectory) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out", "--no-mosaic"});
  fs::create_directory(path("m"));
  fs::copy(path("out/frames.tum"), path("m/mosaic.json"));
  expect_kept("m/mosaic.json", {"mosaic", "out", "--trajectory", "m/mosaic.json", "--out", "m"});
}

TEST_F(Inputs, ReportKeepsTheStore) {
  write("s.yaml", std::string(kSmallSurvey) + "estimators: [{type: ekf}]\ntrials: 1\n");
  fathom_done({"compare", "s.yaml", "--out", "r/figures", "--no-cache", "--quiet"});
  expect_kept("r/figures/results.sqlite", {"report", "r/figures", "--out", "r"});
}

}  // namespace
}  // namespace fathom::test
