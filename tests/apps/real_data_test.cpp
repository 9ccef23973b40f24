// The issue's own figures, through the command line.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"
#include "support/planar.hpp"

namespace fathom::test {
namespace {

using ::testing::ContainsRegex;

class RealData : public CommandLine {};

// Least F of each file, found by independent solvers (README.md of the data).
TEST_F(RealData, ABatchSolveFromOdometryReachesTheOptimum) {
  FATHOM_REQUIRE_DATA("pose_graphs");
  const std::vector<std::pair<std::string, double>> optima{{"intel", 45.0047},
                                                           {"CSAIL", 40.5551},
                                                           {"manhattan", 3549.0368},
                                                           {"M3500", 137.913},
                                                           {"ring", 11.1631}};
  for (const auto& [name, optimum] : optima) {
    fathom_done({"solve", data_path("pose_graphs/" + name + ".g2o").string(), "--estimator",
                 "ceres_pose_graph", "--mode", "batch", "--out", name});
    const nlohmann::json metrics = json_of(name + "/metrics.json");
    EXPECT_NEAR(metrics.at("chi2").get<double>(), optimum, 1e-4 * optimum) << name;
    EXPECT_EQ(metrics.at("outcome"), "converged") << name;
  }
}

TEST_F(RealData, ToroTokensAreReadRight) {
  FATHOM_REQUIRE_DATA("pose_graphs/M3500a.g2o");
  const Ended ended = fathom_done({"check", data_path("pose_graphs/M3500a.g2o").string()});
  EXPECT_THAT(ended.out, ContainsRegex("F +58265[0-9.]+ at the file's guess"));
}

class Copr : public RealData {
 protected:
  /// Every registration of the log against the reference poses.
  void expect_no_wrong_loop() const {
    const MeasurementLog log = read_g2o(path("out/measurements.g2o"));
    const auto truth = read_tum(path("out/ground_truth.tum"));
    ASSERT_EQ(truth.size(), log.size());
    EXPECT_GT(log.registration_count(), 200u);
    for (std::size_t k = 1; k < log.size(); ++k) {
      for (const RelativePose& z : log.arrival(k).registrations) {
        const Pose error = between(between(truth[z.from].pose, truth[z.to].pose), z.motion);
        EXPECT_LT(error.position().norm(), 1.0) << z.from << " -> " << z.to;
        EXPECT_LT(std::abs(error.theta), 0.2) << z.from << " -> " << z.to;
      }
    }
  }

  /// The ground truth of the run with keyframe numbers for time stamps, as `solve` has it.
  void write_truth_by_keyframe() const {
    auto truth = read_tum(path("out/ground_truth.tum"));
    for (std::size_t k = 0; k < truth.size(); ++k) {
      truth[k].time_ns = static_cast<std::int64_t>(k) * 1'000'000'000;
    }
    write("truth.tum", to_tum(truth));
  }
};

// The front end takes nearly all of the time, so it runs once; its log goes to the others.
TEST_F(Copr, RealPicturesGiveFifteenCentimetres) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  fathom_done({"run", FATHOM_SOURCE_DIR "/configs/image_folder.yaml", "--out", "out", "--set",
               "dataset.path=" + data_path("copr").string(), "--set",
               "front_end.keyframes.separation_frames=1"});
  const nlohmann::json metrics = json_of("out/metrics.json");
  EXPECT_EQ(metrics.at("estimator"), "trajectory_iekf");
  EXPECT_EQ(metrics.at("alignment"), "origin");
  EXPECT_EQ(metrics.at("keyframes"), 38);
  EXPECT_LE(metrics.at("mean_position_error_m"), 0.15);
  EXPECT_NEAR(metrics.at("dead_reckoning").at("mean_position_error_m").get<double>(), 2.57, 0.01);
  expect_no_wrong_loop();
  write_truth_by_keyframe();
  for (const std::string name : {"ekf", "ceres_pose_graph"}) {
    fathom_done({"solve", "out/measurements.g2o", "--mode", "incremental", "--estimator", name,
                 "--ground-truth", "truth.tum", "--out", name, "--set",
                 "estimator.shared_errors=independent"});
    EXPECT_LE(json_of(name + "/metrics.json").at("mean_position_error_m"), 0.15) << name;
  }
}

}  // namespace
}  // namespace fathom::test
