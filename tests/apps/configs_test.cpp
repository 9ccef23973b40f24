// Every shipped configuration runs, made small through --set.

#include <filesystem>
#include <map>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "apps/command_line.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/results/result_store.hpp"
#include "support/data.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;

class Configs : public CommandLine {
 protected:
  static fs::path folder() { return fs::path(FATHOM_SOURCE_DIR) / "configs"; }

  /// Runs or compares it with these settings and a small camera. Its error is to be below that of
  /// dead reckoning times `at_most`.
  void expect_runs(const std::string& command, const std::string& name, Arguments settings,
                   const std::string& metrics, double at_most = 1.0) const {
    Arguments arguments{command, (folder() / name).string(), "--out", "out", "--quiet"};
    for (const std::string& setting : settings) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    fathom_done(arguments);
    const nlohmann::json json = json_of("out/" + metrics);
    EXPECT_EQ(json.at("outcome"), "converged");
    EXPECT_GT(json.at("loop_closures"), 0);
    const double dead_reckoning_m = json.at("dead_reckoning").at("mean_position_error_m");
    EXPECT_LT(json.at("mean_position_error_m"), at_most * dead_reckoning_m);
  }
};

const std::vector<std::string> kSmallCamera{"dataset.camera.width=200", "dataset.camera.height=150",
                                            "dataset.camera.fx=150", "dataset.camera.fy=150",
                                            "front_end.ransac.max_error_m=0.05"};

std::vector<std::string> with_small_camera(std::vector<std::string> settings) {
  settings.insert(settings.end(), kSmallCamera.begin(), kSmallCamera.end());
  return settings;
}

/// Two legs of 3 m, once.
std::vector<std::string> with_short_legs(std::vector<std::string> settings) {
  settings.insert(settings.end(), {"dataset.mission.legs=2", "dataset.mission.leg_length_m=3",
                                   "surveys=1", "trials=1"});
  return with_small_camera(std::move(settings));
}

/// The pool, flown at twice the speed with two legs, once.
std::vector<std::string> with_quick_pool() {
  return with_small_camera(
      {"dataset.mission.speed_m_s=0.3", "dataset.mission.legs=2", "surveys=1", "trials=1"});
}

TEST_F(Configs, AreAllTestedHere) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder())) names.insert(entry.path().filename());
  EXPECT_THAT(names, ElementsAreArray({"dunes.yaml", "image_folder.yaml", "quickstart.yaml",
                                       "run.yaml", "studies"}));
  names.erase("studies");
  for (const std::string& name : names) fathom_done({"check", (folder() / name).string()});
  std::set<std::string> studies;
  for (const auto& entry : fs::directory_iterator(folder() / "studies")) {
    studies.insert(entry.path().filename());
    fathom_done({"check", entry.path().string()});
  }
  EXPECT_EQ(joined({studies.begin(), studies.end()}, " "),
            "attitude.yaml attitude_mounting.yaml compass.yaml false_loops_drawn.yaml "
            "few_loops.yaml fixes.yaml holes.yaml long_survey.yaml paper_pool.yaml "
            "paper_registration.yaml paper_registration_pool.yaml paper_separation.yaml "
            "paper_simulated.yaml real_pictures.yaml regimes.yaml regimes_survey.yaml "
            "shared_errors_altimeter.yaml shared_errors_drawn.yaml "
            "shared_errors_models.yaml shared_errors_tilt.yaml which_back_end.yaml "
            "wrong_loops.yaml");
}

// Whatever a study sweeps, its camera and front end are those of its first cell.
TEST_F(Configs, RegisterTakesEveryOne) {
  for (const auto& entry : fs::recursive_directory_iterator(folder())) {
    if (entry.path().extension() != ".yaml") continue;
    // The camera's own size, unless the data are somebody else's.
    const std::string text = read_file(entry.path());
    if (text.find("type: simulated\n") == std::string::npos) continue;
    cv::Mat noise(150, 200, CV_8UC1);
    cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 255);
    write_picture(path("a.png"), noise);
    Arguments arguments{"register", "a.png", "a.png", "--config", entry.path().string(),
                        "--altitude-a", "2", "--altitude-b", "2", "--out", "out",
                        // A floor of somebody else's need not be there.
                        "--set", "dataset.world.picture=''"};
    for (const std::string& setting : kSmallCamera) {
      arguments.insert(arguments.end(), {"--set", setting});
    }
    fathom_done(arguments);
  }
}

TEST_F(Configs, RunRuns) {
  expect_runs(
      "run", "run.yaml",
      with_small_camera({"dataset.mission.loop_length_m=3", "dataset.mission.loop_width_m=2",
                         "dataset.mission.loop_overrun_m=1"}),
      "metrics.json");
}

TEST_F(Configs, QuickstartRuns) {
  expect_runs("compare", "quickstart.yaml",
              with_small_camera({"dataset.mission.legs=2", "dataset.mission.leg_length_m=3",
                                 "surveys=1", "trials=2"}),
              "incremental_smoother/metrics.json");
}

TEST_F(Configs, DunesRuns) {
  FATHOM_REQUIRE_DATA("worlds/dunes.jpg");
  expect_runs("compare", "dunes.yaml",
              with_small_camera({"dataset.world.picture=" + data_path("worlds/dunes.jpg").string(),
                                 "dataset.mission.legs=2", "dataset.mission.leg_length_m=3"}),
              "trajectory_iekf/metrics.json");
}

// The first level has no added noise: over a short way loops add little to visual odometry.
TEST_F(Configs, PaperSimulatedRuns) {
  expect_runs("compare", "studies/paper_simulated.yaml", with_short_legs({"jobs=1"}),
              "ekf/metrics.json", 1.2);
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 10u * 6u);
}

TEST_F(Configs, PaperRegistrationRuns) {
  expect_runs("compare", "studies/paper_registration.yaml", with_short_legs({}), "ekf/metrics.json",
              1.2);
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 10u * 5u);
}

TEST_F(Configs, PaperRegistrationPoolRuns) {
  expect_runs("compare", "studies/paper_registration_pool.yaml", with_quick_pool(),
              "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 8u * 5u);
}

TEST_F(Configs, PaperSeparationRuns) {
  expect_runs("compare", "studies/paper_separation.yaml", with_short_legs({}), "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 4u * 5u);
}

TEST_F(Configs, PaperPoolRuns) {
  expect_runs("compare", "studies/paper_pool.yaml", with_quick_pool(), "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 8u * 5u);
}

TEST_F(Configs, RealPicturesRuns) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  expect_runs("compare", "studies/real_pictures.yaml",
              {"dataset.path=" + data_path("copr").string(), "trials=1",
               "front_end.features.max_features=500"},
              "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 4u * 4u);
}

TEST_F(Configs, WrongLoopsRuns) {
  expect_runs("compare", "studies/wrong_loops.yaml", with_short_legs({}), "truncated/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 12u * 10u);
}

TEST_F(Configs, FalseLoopsDrawnRuns) {
  expect_runs("compare", "studies/false_loops_drawn.yaml",
              {"dataset.mission.legs=2", "dataset.mission.leg_length_m=8",
               "dataset.mission.loop_length_m=8", "dataset.mission.loop_width_m=4",
               "dataset.mission.loop_overrun_m=4", "trials=1"},
              "truncated/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 96u * 6u);
}

TEST_F(Configs, RegimesRun) {
  expect_runs("compare", "studies/regimes.yaml", {"trials=1"}, "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 36u * 11u);
  EXPECT_TRUE(fs::exists(path("out/figures/regime_map_loops_6.svg")));
}

TEST_F(Configs, RegimesSurveyRun) {
  expect_runs("compare", "studies/regimes_survey.yaml", {"trials=1"}, "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 24u * 11u);
}

TEST_F(Configs, SharedErrorsOfTheAltimeterRun) {
  expect_runs("compare", "studies/shared_errors_altimeter.yaml", with_short_legs({}),
              "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 24u * 5u);
}

TEST_F(Configs, SharedErrorsOfATiltRun) {
  expect_runs("compare", "studies/shared_errors_tilt.yaml", with_short_legs({}),
              "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 24u * 5u);
}

TEST_F(Configs, SharedErrorsDrawnRun) {
  expect_runs("compare", "studies/shared_errors_drawn.yaml", {"trials=1"}, "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 4u * 12u);
}

TEST_F(Configs, SharedErrorsModelsRun) {
  expect_runs("compare", "studies/shared_errors_models.yaml", with_short_legs({}),
              "ekf/metrics.json", 1.2);
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 2u * 13u);
}

TEST_F(Configs, AttitudeRuns) {
  expect_runs("compare", "studies/attitude.yaml", with_short_legs({}), "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 6u * 5u);
}

TEST_F(Configs, AttitudeMountingRuns) {
  expect_runs("compare", "studies/attitude_mounting.yaml", with_short_legs({}), "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 3u * 5u);
}

TEST_F(Configs, CompassRuns) {
  expect_runs("compare", "studies/compass.yaml", {"trials=1"}, "ekf/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 36u * 6u);
}

TEST_F(Configs, FixesRun) {
  expect_runs("compare", "studies/fixes.yaml", {"trials=1"}, "truncated/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 18u * 14u);
}

TEST_F(Configs, HolesRun) {
  expect_runs("compare", "studies/holes.yaml", {"trials=1"}, "incremental_smoother/metrics.json");
  EXPECT_EQ(ResultStore::open(path("out")).runs().size(), 24u * 6u);
}

// image_folder.yaml runs as it is in real_data_test.cpp.

}  // namespace
}  // namespace fathom::test
