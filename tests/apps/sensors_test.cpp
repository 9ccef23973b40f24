// Compass, fixes and holes through the command line: simulate, check, run.

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/core/files.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kPlain = R"(dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: single_loop, loop_length_m: 2.4, loop_width_m: 1.6, loop_overrun_m: 0.8,
            turn_radius_m: 0.4}
  camera: {width: 160, height: 120, fx: 130, fy: 131}
front_end:
  keyframes: {separation_frames: 3}
  candidates: {max_distance_m: 1.6}
  ransac: {max_error_m: 0.05}
)";
const std::string kSurvey = kPlain + R"(dataset.compass: {interval_s: 1, sigma_rad: 0.0175}
dataset.fixes: {interval_s: 4, sigma_m: 0.1}
dataset.holes: {count: 1, length_s: 4}
)";

class Sensors : public CommandLine {
 protected:
  /// A survey with all of them, written out to `data`.
  void simulate() const {
    write("c.yaml", kSurvey);
    fathom_done({"simulate", "c.yaml", "--out", "data"});
  }
  /// A survey, written out to `data`, runs as it does by itself.
  void expect_same_run(const std::string& survey) const {
    write("c.yaml", survey);
    fathom_done({"simulate", "c.yaml", "--out", "data"});
    fathom_done({"run", "c.yaml", "--out", "direct"});
    fathom_done({"run", "data/run.yaml", "--out", "read"});
    for (const char* metric : {"chi2", "anees", "mean_position_error_m", "registrations"}) {
      const double expected = json_of("direct/metrics.json").at(metric).get<double>();
      EXPECT_NEAR(json_of("read/metrics.json").at(metric).get<double>(), expected, 1e-6 * expected)
          << metric;
    }
  }
  std::string rows(const std::string& name) const { return read_text(path("data/mav0/" + name)); }
};

TEST_F(Sensors, SimulateWritesThemAndTheFolderRunsAsTheSimulation) {
  simulate();
  EXPECT_THAT(rows("compass0/data.csv"), HasSubstr("#timestamp [ns],heading [rad],sigma [rad]\n"));
  EXPECT_THAT(rows("position0/data.csv"), HasSubstr("#timestamp [ns],x [m],y [m],var_x [m^2]"));
  EXPECT_THAT(read_text(path("data/run.yaml")),
              AllOf(HasSubstr("gap_intervals: 1.5"), HasSubstr("interval_s: 4")));
  const std::string direct = fathom_done({"run", "c.yaml", "--out", "direct"}).out;
  EXPECT_THAT(direct, AllOf(HasSubstr("headings and fixes; keyframe 0 begins at"),
                            HasSubstr("steps of dead reckoning are holes")));
  const std::string read = fathom_done({"run", "data/run.yaml", "--out", "read"}).out;
  const auto first_lines = [](const std::string& text) {
    return text.substr(0, text.find("\n\n"));
  };
  EXPECT_EQ(first_lines(read), first_lines(direct));
  EXPECT_NEAR(json_of("read/metrics.json").at("mean_position_error_m").get<double>(),
              json_of("direct/metrics.json").at("mean_position_error_m").get<double>(), 1e-6);
}

// Its motions know what a run estimates of the pictures, so that they are made again.
TEST_F(Sensors, VisualOdometryOfTheFolderIsThatOfTheSimulation) {
  expect_same_run(kPlain +
                  "dataset.odometry: {source: visual_odometry, sigma_x_m: 0.002, sigma_y_m: 0.002, "
                  "sigma_theta_rad: 0.001}\n");
  EXPECT_FALSE(std::filesystem::exists(path("data/mav0/odometry0")));
  EXPECT_TRUE(json_of("read/run.json").at("front_end").at("visual_odometry"));
}

TEST_F(Sensors, JumpsAreInTheFolderToo) {
  expect_same_run(kPlain +
                  "dataset.compass: {interval_s: 1}\n"
                  "dataset.fixes: {interval_s: 1, sigma_m: 0.1, jump_share: 0.2}\n");
  EXPECT_THAT(rows("position0/sensor.yaml"), HasSubstr("outliers: keep\n"));
}

TEST_F(Sensors, WhatIsOffIsNoKeyOfTheFolder) {
  expect_same_run(kPlain + "dataset.compass.interval_s: off\ndataset.fixes.interval_s: off\n");
}

TEST_F(Sensors, TheFolderIsToldTheStartThatWasDrawn) {
  expect_same_run(kPlain +
                  "evaluation.alignment: none\n"
                  "dataset.start: {x_m: 1, y_m: 2, heading_rad: 0.5, sigma_m: 0.3, "
                  "sigma_rad: 0.1}\n");
}

TEST_F(Sensors, CheckSaysWhatThereIs) {
  simulate();
  const Ended checked = fathom({"check", "data"});
  EXPECT_THAT(checked.out, AllOf(HasSubstr("headings, one in 1 s, median sigma 1 degrees"),
                                 HasSubstr("in x and y, one in 4 s, median sigma 0.1 m"),
                                 HasSubstr("odometry: 1 hole, the longest over 4 s of pictures")));
  // Pictures lie in it, so that a run without the key refuses them.
  EXPECT_EQ(checked.status, 2);
  EXPECT_THAT(checked.err, HasSubstr("or dataset.gap_intervals, which makes holes"));
}

TEST_F(Sensors, ARunMayLeaveThemOut) {
  simulate();
  const std::string out =
      fathom_done({"run", "data/run.yaml", "--out", "r", "--set", "dataset.fixes.use=false",
                   "--set", "dataset.compass.use=false"})
          .out;
  EXPECT_THAT(out, ::testing::Not(HasSubstr("headings and fixes")));
}

TEST_F(Sensors, LatitudeWithoutAnOriginIsRefusedAndTakenWithOne) {
  simulate();
  std::filesystem::remove_all(path("data/mav0/position0"));
  std::filesystem::create_directory(path("data/mav0/position0"));
  std::ofstream(path("data/mav0/position0/data.csv"))
      << "#timestamp [ns],latitude [deg],longitude [deg],var_north [m^2],cov_north_east [m^2],"
         "var_east [m^2]\n0,40,3,0.01,0,0.01\n";
  const std::string refused = refusal({"run", "data/run.yaml", "--out", "r"});
  EXPECT_THAT(refused, HasSubstr("position0/data.csv:2: fixes in latitude and longitude, and "
                                 "nothing says where the map lies on Earth; expected "
                                 "dataset.origin: {latitude: , longitude: , heading: }"));
  const Ended ended =
      fathom({"run", "data/run.yaml", "--out", "r", "--set", "dataset.origin.latitude=40", "--set",
              "dataset.origin.longitude=3", "--set", "dataset.origin.heading=30"});
  FATHOM_REQUIRE_FEATURE("proj");
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST_F(Sensors, CheckSaysWhatARunOfFixesNeeds) {
  write("c.yaml", kPlain);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  std::filesystem::create_directory(path("data/mav0/position0"));
  std::ofstream(path("data/mav0/position0/data.csv"))
      << "#timestamp [ns],latitude [deg],longitude [deg],var_north [m^2],cov_north_east [m^2],"
         "var_east [m^2]\n0,40,3,0.01,0,0.01\n";
  EXPECT_THAT(fathom_done({"check", "data"}).out,
              AllOf(HasSubstr("fixes: 1 in latitude and longitude"),
                    HasSubstr("warning: fixes in latitude and longitude: a run needs "
                              "dataset.origin"),
                    HasSubstr("warning: fixes without a compass: a run needs "
                              "dataset.start.heading_rad")));
  EXPECT_THAT(fathom_done({"check", "data", "--set", "dataset.fixes.use=false"}).out,
              ::testing::Not(HasSubstr("a run needs")));
}

TEST_F(Sensors, KeysOfWhatIsNotThereAreRefused) {
  for (const std::string key :
       {"compass.sigma_rad", "fixes.jump_share", "holes.length_s", "gap_sigma_rad"}) {
    write("c.yaml", "dataset." + key + ": 0.5\n");
    EXPECT_THAT(refusal({"run", "c.yaml", "--out", "r"}), HasSubstr("has no use for it")) << key;
  }
  for (const std::string key : {"holes.count", "gap_sigma_m", "speed_limit_m_s"}) {
    write("c.yaml", "dataset.odometry.source: visual_odometry\ndataset." + key + ": 2\n");
    EXPECT_THAT(refusal({"run", "c.yaml", "--out", "r"}),
                HasSubstr("dataset." + key +
                          ": dataset.odometry.source visual_odometry has no use for it"));
  }
}

}  // namespace
}  // namespace fathom::test
