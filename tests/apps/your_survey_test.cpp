// A folder of one's own, without a configuration: check, run, compare, init.

#include "apps/your_survey.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(YourSurvey, AFolderNeedsNoConfiguration) {
  simulate("data");
  const Ended checked = fathom_done({"check", "data"});
  EXPECT_THAT(checked.out,
              AllOf(HasSubstr("footprint: "), HasSubstr("keyframes: "),
                    ContainsRegex("candidates by dead reckoning: [1-9]"),
                    HasSubstr("features in pictures"), HasSubstr("nothing looks wrong")));
  const Ended ran = fathom_done({"run", "data", "--out", "run", "--set", "estimator.type=ekf"});
  EXPECT_GT(number("run", "loop_closures"), 10);
  EXPECT_LT(number("run", "mean_position_error_m"), 0.03);
  const nlohmann::json manifest = json_of("run/run.json");
  EXPECT_EQ(manifest.at("configuration").at("front_end.covariance.tilt_sigma_rad"), "estimated");
  const auto& metres = manifest.at("front_end").at("in_metres");
  EXPECT_NEAR(metres.at("max_error_m").at(1).get<double>(), 7.5 * 2.0 / 130.0, 0.02);
  EXPECT_LE(metres.at("keyframe_step_m").at(0), metres.at("keyframe_step_m").at(2));
  fathom_done({"compare", "data", "--out", "study", "--no-cache"});
  EXPECT_TRUE(fs::exists(path("study/report.html")));
  EXPECT_THAT(bytes_of("study/table.txt"), HasSubstr("incremental_smoother  1/1 done"));
}

// As docs/your_survey.md has it.
TEST_F(YourSurvey, ARunAndAStudyHaveFoldersOfTheirOwn) {
  simulate("data");
  fathom_done({"run", "data"});
  fathom_done({"compare", "data", "--set", "estimators.0.type=ekf"});
  EXPECT_TRUE(fs::exists(path("runs/data/trajectory.tum")));
  EXPECT_TRUE(fs::exists(path("runs/data-study/report.html")));
  EXPECT_THAT(fathom_done({"status", "runs/data", "runs/data-study"}).out,
              AllOf(HasSubstr("a run, no study"), HasSubstr("1 of 1 runs are done")));
  EXPECT_THAT(refusal({"merge", "runs/data-study", "--out", "runs/data"}),
              HasSubstr("runs/data: holds a run; a study needs a folder of its own"));
}

TEST_F(YourSurvey, InitWritesWhatRunsAndComparesAlike) {
  simulate("data");
  const Ended made = fathom_done({"init", "data", "--out", "config"});
  EXPECT_THAT(made.out, AllOf(HasSubstr("assumed: "), HasSubstr("config/run.yaml")));
  const std::string text = bytes_of("config/run.yaml");
  EXPECT_THAT(text, AllOf(HasSubstr("keyframes.min_overlap: 0.85  # "),
                          HasSubstr("ransac.max_error_px: 7.5  # "), HasSubstr("# Assumed:")));
  fathom_done({"run", "config/run.yaml", "--out", "configured", "--no-mosaic"});
  fathom_done({"run", "data", "--out", "plain", "--no-mosaic"});
  EXPECT_EQ(bytes_of("configured/measurements.g2o"), bytes_of("plain/measurements.g2o"));
  EXPECT_EQ(bytes_of("configured/trajectory.tum"), bytes_of("plain/trajectory.tum"));
  fathom_done({"check", "config/study.yaml"});
}

TEST_F(YourSurvey, WhatTheAltimeterStatesIsUsedAndAMisspeltKeyIsNamed) {
  simulate("data");
  const fs::path yaml = path("data/mav0/altimeter0/sensor.yaml");
  const std::string exact = "loops tell how exact altitudes are";
  EXPECT_THAT(fathom_done({"init", "data", "--out", "exact"}).out, HasSubstr(exact));
  fathom_done({"run", "data", "--out", "silent", "--no-mosaic"});
  std::ofstream(yaml) << "sigma_absolute: 0.02\n";
  EXPECT_THAT(fathom_done({"init", "data", "--out", "stated"}).out, Not(HasSubstr(exact)));
  fathom_done({"run", "data", "--out", "stated_run", "--no-mosaic"});
  EXPECT_NE(bytes_of("silent/measurements.g2o"), bytes_of("stated_run/measurements.g2o"));
  // By the key alone it is the same, to the last bit.
  std::ofstream(yaml) << "sensor_type: altimeter\n";
  fathom_done({"run", "data", "--out", "keyed", "--no-mosaic", "--set",
               "front_end.covariance.altitude_sigma_m=0.02"});
  EXPECT_EQ(bytes_of("keyed/measurements.g2o"), bytes_of("stated_run/measurements.g2o"));
  std::ofstream(yaml) << "sigma_absolut: 0.02\n";
  const char* const named = "sensor.yaml:1: 'sigma_absolut' is not read; ";
  EXPECT_THAT(fathom_done({"check", "data"}).out, HasSubstr(named));
  const Ended ran = fathom_done({"run", "data", "--out", "named", "--no-mosaic"});
  EXPECT_THAT(ran.out + ran.err, HasSubstr(named));
}

TEST_F(YourSurvey, AFolderThatIsNoneSaysWhatIsExpected) {
  fs::create_directory(path("empty"));
  EXPECT_THAT(refusal({"run", "empty"}),
              HasSubstr("empty: is empty; expected a folder in the EuRoC/ASL layout"));
  EXPECT_THAT(refusal({"init", "empty"}), HasSubstr("expected a folder in the EuRoC/ASL layout"));
}

// From 0.5, 2, 8 and 30 m over one floor: the same loops, and errors as much larger. A procedural
// floor would not do, as its ripples have their length in metres.
TEST_F(YourSurvey, FromAnotherAltitudeItIsTheSame) {
  write_floor("floor.png");
  std::map<double, double> errors;
  std::map<double, std::vector<std::pair<std::size_t, std::size_t>>> loops;
  for (const double scale : {0.25, 1.0, 4.0, 15.0}) {
    write("survey.yaml", survey(scale));
    fathom_done({"run", "survey.yaml", "--out", "out", "--no-mosaic", "--set",
                 "dataset.world.picture=" + path("floor.png").string()});
    errors[scale] = number("out", "mean_position_error_m") / scale;
    const MeasurementLog log = read_g2o(path("out/measurements.g2o"));
    for (std::size_t k = 1; k < log.size(); ++k) {
      for (const RelativePose& z : log.arrival(k).registrations) {
        loops[scale].emplace_back(z.from, z.to);
      }
    }
  }
  EXPECT_GT(loops[1.0].size(), 50u);
  for (const double scale : {0.25, 4.0, 15.0}) {
    EXPECT_EQ(loops[scale], loops[1.0]) << scale;
    EXPECT_NEAR(errors[scale], errors[1.0], 0.05 * errors[1.0]) << scale;
  }
}

TEST_F(YourSurvey, ARunWithoutLoopsSaysWhy) {
  write("line.yaml",
        "dataset:\n  type: simulated\n  world: {metres_per_pixel: 0.01}\n"
        "  mission: {type: waypoints, waypoints_m: [0, 0, 9, 0]}\n"
        "  camera: {width: 160, height: 120, fx: 130, fy: 130}\n"
        "front_end: {keyframes: {separation_frames: 8}, candidates: {max_distance_m: 1.0}}\n");
  const Ended ended = fathom_done({"run", "line.yaml", "--out", "out", "--no-mosaic"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("warning: no loop candidates among"),
                               HasSubstr("the path never returns")));
  EXPECT_THAT(json_of("out/run.json").at("remarks").at(0).get<std::string>(),
              HasSubstr("no loop candidates"));
}

// Few loops after much drift: one linearisation is not enough, and the batch solve stands beside.
TEST_F(YourSurvey, AMapThatDoesNotFitHasTheBatchOptimumBesideIt) {
  write("survey.yaml", survey(1.0));
  const std::vector<std::string> run{"run",   "survey.yaml",
                                     "--out", "out",
                                     "--set", "estimator.type=ekf",
                                     "--set", "front_end.keyframes.separation_frames=4",
                                     "--set", "front_end.candidates.max_distance_m=0.8"};
  std::vector<std::string> drifting = run;
  drifting.insert(drifting.end(), {"--set", "dataset.odometry.sigma_theta_rad=0.1"});
  const Ended ended = fathom_done(drifting);
  EXPECT_THAT(ended.out, AllOf(ContainsRegex("batch_optimum +converged"),
                               HasSubstr("      batch_optimum/mosaic.png: "),
                               HasSubstr("warning: the map of ekf does not fit its own")));
  EXPECT_EQ(tum("out/batch_optimum/trajectory.tum").size(), tum("out/trajectory.tum").size());
  expect_picture("out/batch_optimum/mosaic.png");
  // A run that fits takes the older one's away.
  const Ended fits = fathom_done(run);
  EXPECT_THAT(fits.out, Not(HasSubstr("batch_optimum")));
  EXPECT_FALSE(fs::exists(path("out/batch_optimum")));
}

// Altitudes that are 3.28 times too large show in the length of registered motions.
TEST_F(YourSurvey, AnAltitudeInFeetIsNoticed) {
  simulate("data");
  const fs::path csv = path("data/mav0/altimeter0/data.csv");
  std::ifstream in(csv);
  std::string feet;
  for (std::string line; std::getline(in, line);) {
    const std::size_t comma = line.find(',');
    if (!line.starts_with("#")) {
      line =
          line.substr(0, comma + 1) + std::to_string(3.28084 * std::stod(line.substr(comma + 1)));
    }
    feet += line + "\n";
  }
  in.close();
  write("data/mav0/altimeter0/data.csv", feet);
  const Ended ended = fathom({"run", "data", "--out", "out", "--no-mosaic"});
  EXPECT_THAT(ended.out,
              ContainsRegex("registered motions are 3\\.[123][0-9]* ± [^ ]* times as long"));
  // No altimeter is off by so much: it is not taken for one's error.
  EXPECT_THAT(ended.out, HasSubstr("altitude: 0 mm assumed: "));
}

TEST_F(YourSurvey, OnTheKiteTheDefaultsClose220Loops) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  const Ended ended =
      fathom_done({"run", data_path("copr").string(), "--out", "out", "--no-mosaic"});
  // The reference knows no tilt, so what loops tell of it is no error of theirs against it.
  EXPECT_LE(number("out", "mean_position_error_m"), 0.35);
  EXPECT_LE(number("out", "anees"), 1.2);
  EXPECT_GE(number("out", "loop_closures"), 220);
  EXPECT_THAT(ended.out, ContainsRegex("roll and pitch: [34][0-9.]* mrad \\["));
  EXPECT_THAT(ended.out, ContainsRegex("own errors of registrations: [34][0-9.]* times"));
  const MeasurementLog log = read_g2o(path("out/measurements.g2o"));
  std::map<std::int64_t, Pose> truth;
  for (const StampedPose& pose : tum("out/ground_truth.tum")) truth[pose.time_ns] = pose.pose;
  const auto keyframes = tum("out/trajectory.tum");
  for (const RelativePose& z : log.edges()) {
    if (z.to == z.from + 1) continue;
    const Pose error = between(
        between(truth.at(keyframes[z.from].time_ns), truth.at(keyframes[z.to].time_ns)), z.motion);
    EXPECT_LT(error.position().norm(), 1.0) << z.from << " -> " << z.to;
    EXPECT_LT(std::abs(error.theta), 0.2) << z.from << " -> " << z.to;
  }
}

}  // namespace
}  // namespace fathom::test
