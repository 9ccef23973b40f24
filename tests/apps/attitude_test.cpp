// A survey whose roll and pitch are measured, through the real program.

#include <filesystem>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class Attitude : public Commands {
 protected:
  void SetUp() override {
    write("tilted.yaml", std::string(kSmallSurvey) + "dataset.attitude.both_sigma_rad: 0.03\n");
    const std::string measured = bytes_of("tilted.yaml");
    write("measured.yaml", measured + "dataset.attitude.measured_sigma_rad: 0.001\n");
  }

  double error_m(const std::string& run) const {
    return json_of(run + "/metrics.json").at("mean_position_error_m");
  }

  // A folder is run by its run.yaml, which names it.
  void run_folder(const std::string& folder, const std::string& out) {
    fathom_done({"run", folder + "/run.yaml", "--out", out});
  }
};

TEST_F(Attitude, AFolderIsRunAsTheSimulationIs) {
  fathom_done({"run", "measured.yaml", "--out", "of-config"});
  fathom_done({"simulate", "measured.yaml", "--out", "folder"});
  ASSERT_TRUE(fs::exists(path("folder/mav0/attitude0/sensor.yaml")));
  EXPECT_THAT(fathom_done({"check", "folder"}).out, HasSubstr("attitude: roll "));
  run_folder("folder", "of-folder");
  expect_same_trajectory("of-config/trajectory.tum", "of-folder/trajectory.tum", 1e-9);
  EXPECT_EQ(bytes_of("of-config/mosaic.png"), bytes_of("of-folder/mosaic.png"));

  const fs::path attitude = path("folder/mav0/attitude0");
  write("folder/mav0/attitude0/data.csv", "0,0.1,0.1,0.1\n1000,3,0,0.1\n");
  EXPECT_THAT(refusal({"run", "folder", "--out", "no"}),
              HasSubstr("attitude0/data.csv:2: roll 3 is beyond 1 rad"));

  // Without it, the survey that measured none.
  fs::remove_all(attitude);
  fathom_done({"run", "tilted.yaml", "--out", "unmeasured"});
  run_folder("folder", "without");
  expect_same_trajectory("unmeasured/trajectory.tum", "without/trajectory.tum", 1e-9);
  EXPECT_THAT(fathom_done({"check", "folder"}).out, Not(HasSubstr("attitude")));
  EXPECT_LT(error_m("of-folder"), 0.2 * error_m("without"));
}

TEST_F(Attitude, AMosaicAndVisualOdometryUseIt) {
  write("seen.yaml", bytes_of("measured.yaml") + kVisualOdometry);
  fathom_done({"run", "seen.yaml", "--out", "seen"});
  fathom_done({"run", "tilted.yaml", "--out", "unmeasured"});
  const auto odometry = [&](const std::string& sigma) {
    fathom_done({"run", "seen.yaml", "--out", "vo" + sigma, "--set",
                 "dataset.attitude.measured_sigma_rad=" + sigma});
    return bytes_of("vo" + sigma + "/dead_reckoning.tum");
  };
  EXPECT_NE(odometry("off"), odometry("0"));
  fathom_done({"mosaic", "seen", "--blend", "seams", "--out", "again"});
  EXPECT_EQ(bytes_of("again/mosaic.png"), bytes_of("seen/mosaic.png"));
  EXPECT_EQ(bytes_of("again/footprints.csv"), bytes_of("seen/footprints.csv"));
  const auto on_truth = [&](const std::string& sigma) {
    fathom_done({"mosaic", "seen", "--out", "truth" + sigma, "--trajectory",
                 path("seen/ground_truth.tum").string(), "--set",
                 "dataset.attitude.measured_sigma_rad=" + sigma});
    return bytes_of("truth" + sigma + "/mosaic.png");
  };
  EXPECT_NE(on_truth("off"), on_truth("0"));
}

TEST_F(Attitude, AMountingErrorOfWhatIsNotMeasuredIsRefused) {
  EXPECT_THAT(refusal({"run", "tilted.yaml", "--out", "no", "--set",
                       "dataset.attitude.roll_mounting_error_rad=0.01"}),
              HasSubstr("dataset.attitude.roll_mounting_error_rad"));
}

}  // namespace
}  // namespace fathom::test
