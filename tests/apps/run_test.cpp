// run, compare and simulate: outputs there, parsable, and in agreement.

#include <filesystem>
#include <regex>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Commands, RunWritesItsFolder) {
  write("c.yaml", kSmallSurvey);
  const Ended ended = fathom_done({"run", "c.yaml", "--out", "out", "--seed", "3", "--set",
                                   "estimator.type=ekf", "--set", "estimator.tolerance=1e-5"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("33 frames, 11 keyframes"), HasSubstr("ekf"),
                               HasSubstr("dead reckoning"), HasSubstr("out/trajectory.png")));
  const nlohmann::json metrics = json_of("out/metrics.json");
  EXPECT_EQ(metrics.at("estimator"), "ekf");
  for (const char* key : {"outcome", "keyframes", "loop_closures", "rejected", "chi2",
                          "chi2_initial", "mean_position_error_m", "ate_rmse_m", "heading_rmse_rad",
                          "anees", "update_ms.median", "total_ms", "alignment"}) {
    EXPECT_TRUE(metrics.contains(key)) << key;
  }
  ASSERT_EQ(metrics.contains("memory_bytes"), FATHOM_MEASURES_MEMORY == 1);
  if (FATHOM_MEASURES_MEMORY == 1) {
    // At the least the covariance of ten poses, at the most a hundred of them.
    EXPECT_GT(metrics.at("memory_bytes"), 30 * 30 * 8);
    EXPECT_LT(metrics.at("memory_bytes"), 100 * 30 * 30 * 8);
  }
  const nlohmann::json manifest = json_of("out/run.json");
  EXPECT_EQ(manifest.at("configuration").at("seed"), "3");
  EXPECT_EQ(manifest.at("estimator").at("options").at("tolerance"), "1e-05");  // the canonical text
  EXPECT_THAT(manifest.at("command_line").get<std::string>(), HasSubstr("run c.yaml --out out"));
  EXPECT_EQ(tum("out/trajectory.tum").size(), 11u);
  EXPECT_EQ(tum("out/frames.tum").size(), 33u);
  EXPECT_EQ(tum("out/dead_reckoning.tum").size(), 33u);
  EXPECT_EQ(tum("out/ground_truth.tum").size(), 33u);
  EXPECT_EQ(read_g2o(path("out/measurements.g2o")).size(), 11u);
  expect_picture("out/trajectory.png");
}

TEST_F(Commands, AnotherBackEndRegistersNoPairAgain) {
  write("c.yaml", kSmallSurvey);
  surroundings_.environment["FATHOM_CACHE"] = path("kept").string();
  const Ended first = fathom_done({"run", "c.yaml", "--out", "first"});
  EXPECT_THAT(first.out, Not(HasSubstr("from the cache")));
  const auto tried = json_of("first/run.json").at("front_end").at("registrations_tried");
  ASSERT_GT(tried, 0);
  const Ended other =
      fathom_done({"run", "c.yaml", "--out", "other", "--set", "estimator.type=ekf"});
  EXPECT_THAT(other.out, HasSubstr(", " + tried.dump() + " from the cache"));
  EXPECT_THAT(fathom_done({"cache"}).out, HasSubstr("  " + tried.dump() + " registrations, "));
  EXPECT_THAT(fathom_done({"run", "c.yaml", "--out", "anew", "--no-cache"}).out,
              Not(HasSubstr("from the cache")));
  EXPECT_THAT(fathom_done({"cache", "--clear"}).out, HasSubstr("  0 registrations, "));
  EXPECT_THAT(refusal({"run", "c.yaml", "--cache", "x", "--no-cache"}), HasSubstr("--no-cache"));
}

TEST_F(Commands, RunsFolderHasTheConfigurationsName) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml"});
  EXPECT_TRUE(std::filesystem::exists(path("runs/c/metrics.json")));
}

TEST_F(Commands, TwoRunsAreTheSameByteForByte) {
  write("c.yaml", std::string(kSmallSurvey) + kVisualOdometry);
  fathom_done({"run", "c.yaml", "--out", "a", "--no-cache"});
  fathom_done({"run", "c.yaml", "--out", "b", "--no-cache"});
  for (const std::string name : {"trajectory.tum", "frames.tum", "measurements.g2o"}) {
    EXPECT_EQ(bytes_of("a/" + name), bytes_of("b/" + name)) << name;
  }
}

TEST_F(Commands, CompareGivesOneLogToAll) {
  write("c.yaml", kSmallSurvey);
  const Ended ended = fathom_done({"compare", "c.yaml", "--out", "out"});
  std::vector<std::string> names;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) names.push_back(entry.name);
  for (const std::string& name : names) {
    EXPECT_THAT(ended.out, HasSubstr(name));
    EXPECT_THAT(bytes_of("out/table.txt"), HasSubstr(name));
    EXPECT_EQ(json_of("out/" + name + "/metrics.json").at("estimator"), name);
    EXPECT_EQ(bytes_of("out/" + name + "/measurements.g2o"), bytes_of("out/ekf/measurements.g2o"));
    EXPECT_LT(json_of("out/" + name + "/metrics.json").at("mean_position_error_m"), 0.03);
    expect_picture("out/" + name + "/trajectory.png");
  }
  expect_picture("out/trajectories.png");
  // What all share lies at the top.
  EXPECT_EQ(bytes_of("out/measurements.g2o"), bytes_of("out/ekf/measurements.g2o"));
  EXPECT_EQ(tum("out/ground_truth.tum").size(), 33u);
  EXPECT_EQ(tum("out/dead_reckoning.tum").size(), 33u);
  const nlohmann::json all = json_of("out/metrics.json");
  ASSERT_EQ(all.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(all[i], json_of("out/" + names[i] + "/metrics.json"));
  }
}

TEST_F(Commands, ASimulationRunsFromDiskAsItDidBefore) {
  write("c.yaml", kSmallSurvey);
  const std::string folder = "it's a survey";  // a quote, to be written as YAML
  for (const Arguments& more :
       {Arguments{}, Arguments{"--set", "dataset.odometry.source=visual_odometry", "--set",
                               "front_end.covariance.altitude_sigma_m=0", "--set",
                               "front_end.covariance.tilt_sigma_rad=0", "--set",
                               "front_end.covariance.own_factor=1"}}) {
    Arguments simulate{"simulate", "c.yaml", "--out", folder};
    Arguments run{"run", "c.yaml", "--out", "direct"};
    simulate.insert(simulate.end(), more.begin(), more.end());
    run.insert(run.end(), more.begin(), more.end());
    fathom_done(simulate);
    fathom_done(run);
    fathom_done({"run", folder + "/run.yaml", "--out", "disk"});
    expect_same_trajectory("direct/trajectory.tum", "disk/trajectory.tum", 1e-9);
    expect_same_trajectory("direct/frames.tum", "disk/frames.tum", 1e-9);
    EXPECT_EQ(json_of("direct/metrics.json").at("registrations"),
              json_of("disk/metrics.json").at("registrations"));
  }
  EXPECT_THAT(fathom_done({"check", folder}).out, HasSubstr("33 "));
}

TEST_F(Commands, AFolderWithoutOdometryRunsOnVisualOdometry) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  fathom_done({"run", "data/run.yaml", "--out", "recorded"});
  EXPECT_EQ(json_of("recorded/run.json").at("front_end").at("visual_odometry"), false);
  // With odometry in the folder and without, it is the pictures that count.
  fathom_done({"run", "data/run.yaml", "--set", "dataset.odometry.source=visual_odometry", "--out",
               "chosen"});
  std::filesystem::remove_all(path("data/mav0/odometry0"));
  const Ended ended = fathom_done({"run", "data/run.yaml", "--out", "without"});
  EXPECT_THAT(ended.out, HasSubstr("dead reckoning by visual odometry, 0 of 32 motions repeated"));
  expect_same_trajectory("chosen/trajectory.tum", "without/trajectory.tum", 1e-12);
  expect_same_trajectory("chosen/dead_reckoning.tum", "without/dead_reckoning.tum", 1e-12);
  for (const std::string run : {"chosen", "without"}) {
    const auto metrics = json_of(run + "/metrics.json");
    EXPECT_EQ(json_of(run + "/run.json").at("front_end").at("visual_odometry"), true);
    EXPECT_LT(metrics.at("mean_position_error_m"), 0.1);
    EXPECT_GT(metrics.at("anees"), 0.0);
  }
}

TEST_F(Commands, CandidatesAreFoundByEachMethodWithinTheirBudget) {
  write("c.yaml", kSmallSurvey);
  const auto run = [&](const std::string& method, const Arguments& more) {
    Arguments arguments{"run",   "c.yaml", "--set", "front_end.candidates.method=" + method,
                        "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ended ended = fathom_done(arguments);
    const auto front_end = json_of("out/run.json").at("front_end");
    EXPECT_EQ(json_of("out/metrics.json").at("registrations_tried"),
              front_end.at("registrations_tried"));
    const std::size_t left_out = front_end.at("registrations_left_out");
    EXPECT_EQ(ended.out.find("left out beyond the budget") != std::string::npos, left_out > 0);
    return std::pair<std::size_t, std::size_t>(front_end.at("registrations_tried"), left_out);
  };
  const auto near = run("distance", {});
  EXPECT_EQ(near.second, 0u);
  EXPECT_GT(run("mahalanobis", {}).first, near.first);
  const auto some = run("mahalanobis", {"--set", "front_end.candidates.max_per_keyframe=1"});
  EXPECT_EQ(some.first, json_of("out/metrics.json").at("keyframes").get<std::size_t>() - 1);
  EXPECT_GT(some.second, 0u);
  for (const std::string mode : {"own", "shared"}) {
    fathom_done({"compare", "c.yaml", "--set", "front_end.candidates.method=mahalanobis", "--set",
                 "association.mode=" + mode, "--out", "study"});
    for (const auto& result : json_of("study/metrics.json")) {
      EXPECT_EQ(result.at("registrations_left_out"), 0);
    }
    std::filesystem::remove_all(path("study"));
  }
  write("o.yaml",
        std::regex_replace(std::string(kSmallSurvey), std::regex(R"(max_distance_m: [0-9.]+)"),
                           "method: overlap, min_overlap: 0.4"));
  fathom_done({"run", "o.yaml", "--out", "overlap"});
  EXPECT_GT(json_of("overlap/metrics.json").at("registrations"), 0);
}

TEST_F(Commands, AComparisonCanBeSimulated) {
  write("c.yaml", std::string(kSmallSurvey) +
                      "estimators: [{type: ekf}, {type: trajectory_iekf, max_iterations: 2}]\n"
                      "association: {reference: trajectory_iekf}\n");
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  EXPECT_THAT(bytes_of("data/run.yaml"),
              HasSubstr("estimator:\n  type: trajectory_iekf\n  max_iterations: 2\n"));
  EXPECT_THAT(fathom_done({"check", "data/run.yaml"}).out, HasSubstr("configuration for 'run'"));
}

}  // namespace
}  // namespace fathom::test
