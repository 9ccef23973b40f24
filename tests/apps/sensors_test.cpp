// Compass, fixes and holes through the command line: simulate, check, run.

#include <fstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/core/files.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kSurvey = R"(dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: single_loop, loop_length_m: 2.4, loop_width_m: 1.6, loop_overrun_m: 0.8,
            turn_radius_m: 0.4}
  camera: {width: 160, height: 120, fx: 130, fy: 131}
  compass: {interval_s: 1, sigma_rad: 0.0175}
  fixes: {interval_s: 4, sigma_m: 0.1}
  holes: {count: 1, length_s: 4}
front_end:
  keyframes: {separation_frames: 3}
  candidates: {max_distance_m: 1.6}
  ransac: {max_error_m: 0.05}
)";

class Sensors : public CommandLine {
 protected:
  /// A survey with all of them, written out to `data`.
  void simulate() const {
    write("c.yaml", kSurvey);
    fathom_done({"simulate", "c.yaml", "--out", "data"});
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

TEST_F(Sensors, KeysOfWhatIsNotThereAreRefused) {
  for (const std::string key :
       {"compass.sigma_rad", "fixes.jump_share", "holes.length_s", "gap_sigma_rad"}) {
    write("c.yaml", "dataset." + key + ": 0.5\n");
    EXPECT_THAT(refusal({"run", "c.yaml", "--out", "r"}), HasSubstr("has no use for it")) << key;
  }
}

}  // namespace
}  // namespace fathom::test
