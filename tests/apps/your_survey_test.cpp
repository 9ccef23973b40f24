// A folder of one's own, without a configuration: check, run, compare, init; and plain pictures.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "apps/commands.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// A loop of some metres, from `scale` times 2 m: all lengths as long, nothing else.
std::string survey(double scale) {
  char text[1024];
  std::snprintf(text, sizeof text,
                "dataset:\n  type: simulated\n"
                "  world: {metres_per_pixel: %.17g}\n"
                "  mission: {type: single_loop, loop_length_m: %.17g, loop_width_m: %.17g, "
                "loop_overrun_m: %.17g, turn_radius_m: %.17g, speed_m_s: %.17g}\n"
                "  altitude: {base_m: %.17g, amplitude_m: %.17g, altimeter_sigma_m: %.17g}\n"
                "  camera: {width: 160, height: 120, fx: 130, fy: 130}\n"
                "  odometry: {sigma_x_m: %.17g, sigma_y_m: %.17g, sigma_theta_rad: 0.01}\n",
                0.01 * scale, 2.4 * scale, 1.6 * scale, 0.8 * scale, 0.4 * scale, 0.5 * scale,
                2.0 * scale, 0.1 * scale, 0.005 * scale, 0.01 * scale, 0.01 * scale);
  return text;
}

class YourSurvey : public Commands {
 protected:
  void simulate(const std::string& folder) const {
    write("survey.yaml", survey(1.0));
    fathom_done({"simulate", "survey.yaml", "--out", folder});
  }

  /// Spots of many sizes, 12 m x 12 m at 1 cm a pixel.
  void write_floor(const std::string& name) const {
    cv::RNG random(7);
    cv::Mat floor(1200, 1200, CV_32F, cv::Scalar(128));
    for (const int side_px : {2, 5, 12, 30}) {
      cv::Mat noise(1200 / side_px, 1200 / side_px, CV_32F);
      random.fill(noise, cv::RNG::NORMAL, 0.0, 25.0);
      cv::Mat wide;
      cv::resize(noise, wide, floor.size(), 0.0, 0.0, cv::INTER_CUBIC);
      floor += wide;
    }
    cv::Mat grey;
    floor.convertTo(grey, CV_8U);
    cv::imwrite(path(name).string(), grey);
  }

  double number(const std::string& run, const std::string& metric) const {
    return json_of(run + "/metrics.json").at(metric).get<double>();
  }
};

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
  EXPECT_EQ(manifest.at("configuration").at("front_end.covariance.tilt_sigma_rad"), "0.005");
  const auto& metres = manifest.at("front_end").at("in_metres");
  EXPECT_NEAR(metres.at("max_error_m").at(1).get<double>(), 7.5 * 2.0 / 130.0, 0.02);
  EXPECT_LE(metres.at("keyframe_step_m").at(0), metres.at("keyframe_step_m").at(2));
  fathom_done({"compare", "data", "--out", "study", "--no-cache"});
  EXPECT_TRUE(fs::exists(path("study/report.html")));
  EXPECT_THAT(bytes_of("study/table.txt"), HasSubstr("incremental_smoother  1/1 done"));
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

TEST_F(YourSurvey, AFolderThatIsNoneSaysWhatIsExpected) {
  fs::create_directory(path("empty"));
  EXPECT_THAT(refusal({"run", "empty"}), HasSubstr("expected a folder in the EuRoC/ASL layout"));
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
  EXPECT_THAT(ended.out, ContainsRegex("registered motions are 3\\.[123][0-9]* times as long"));
}

// The survey's pictures as a camera would have left them, and a height that is about right.
TEST_F(YourSurvey, PlainPicturesCloseTheirLoops) {
  simulate("data");
  fs::create_directory(path("pictures"));
  std::vector<fs::path> taken;
  for (const auto& file : fs::directory_iterator(path("data/mav0/cam0/data"))) {
    taken.push_back(file.path());
  }
  const auto time_of = [](const fs::path& file) { return std::stoll(file.stem().string()); };
  std::ranges::sort(taken, {}, time_of);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const cv::Mat picture = cv::imread(taken[i].string(), cv::IMREAD_GRAYSCALE);
    cv::imwrite(path("pictures/shot" + std::to_string(i) + ".jpg").string(), picture);
  }
  write("run.yaml",
        "dataset:\n  type: pictures\n  path: pictures\n  altitude_m: 2.0\n"
        "  camera: {focal_px: 130}\nestimator: {type: incremental_smoother}\n");
  const Ended ended = fathom_done({"run", "run.yaml", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr("dead reckoning by visual odometry"));
  // Without a configuration what the pictures do not say is asked for.
  EXPECT_THAT(refusal({"run", "pictures"}), HasSubstr("dataset.camera.focal_px"));
  EXPECT_THAT(refusal({"check", "pictures"}), HasSubstr("fathom init pictures"));
  const Arguments given{"--set", "dataset.altitude_m=2.0", "--set", "dataset.camera.focal_px=130"};
  const auto with_given = [&given](Arguments all) {
    all.insert(all.end(), given.begin(), given.end());
    return all;
  };
  const Arguments smoother{"--set", "estimator.type=incremental_smoother", "--no-mosaic"};
  Arguments run = with_given({"run", "pictures", "--out", "given"});
  run.insert(run.end(), smoother.begin(), smoother.end());
  fathom_done(run);
  EXPECT_EQ(bytes_of("given/trajectory.tum"), bytes_of("out/trajectory.tum"));
  fathom_done(with_given({"init", "pictures", "--out", "config"}));
  Arguments configured{"run", "config/run.yaml", "--out", "configured"};
  configured.insert(configured.end(), smoother.begin(), smoother.end());
  fathom_done(configured);
  EXPECT_EQ(bytes_of("configured/trajectory.tum"), bytes_of("out/trajectory.tum"));
  EXPECT_GT(number("out", "loop_closures"), 10);
  expect_picture("out/mosaic.png");
  // The same survey with its sensors: the maps agree, up to the pictures' times.
  fathom_done({"run", "data", "--out", "known", "--no-mosaic"});
  const auto frames = tum("out/frames.tum");
  const auto truth = tum("known/ground_truth.tum");
  ASSERT_EQ(frames.size(), truth.size());
  double error_m = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose expected = between(truth.front().pose, truth[i].pose);
    error_m += (frames[i].pose.position() - expected.position()).norm();
  }
  EXPECT_LT(error_m / static_cast<double>(frames.size()), 0.1);
}

TEST_F(YourSurvey, OnTheKiteTheDefaultsClose220Loops) {
  FATHOM_REQUIRE_DATA("copr/mav0");
  const Ended ended =
      fathom_done({"run", data_path("copr").string(), "--out", "out", "--no-mosaic"});
  EXPECT_LE(number("out", "mean_position_error_m"), 0.15);
  EXPECT_GE(number("out", "loop_closures"), 220);
  EXPECT_THAT(ended.out, HasSubstr("warning: the measurements do not fit each other"));
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
