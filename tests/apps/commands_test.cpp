// Each command does its work: outputs there, parsable, and in agreement.

#include <cmath>
#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/small_config.hpp"
#include "support/planar.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

class Commands : public CommandLine {
 protected:
  void expect_picture(const std::string& name) const {
    const cv::Mat picture = cv::imread(path(name).string());
    ASSERT_FALSE(picture.empty()) << name;
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(picture, mean, deviation);
    EXPECT_GT(deviation[0], 1.0) << name << " is blank";
  }

  std::string bytes_of(const std::string& name) const { return read_file(path(name)); }

  std::vector<StampedPose> tum(const std::string& name) const { return read_tum(path(name)); }

  void expect_same_trajectory(const std::string& a, const std::string& b, double tolerance) const {
    const auto first = tum(a);
    const auto second = tum(b);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_EQ(first[i].time_ns, second[i].time_ns);
      EXPECT_LE(distance(first[i].pose, second[i].pose), tolerance) << i;
    }
  }
};

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

TEST_F(Commands, RunsFolderHasTheConfigurationsName) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml"});
  EXPECT_TRUE(std::filesystem::exists(path("runs/c/metrics.json")));
}

TEST_F(Commands, TwoRunsAreTheSameByteForByte) {
  write("c.yaml", std::string(kSmallSurvey) + kVisualOdometry);
  fathom_done({"run", "c.yaml", "--out", "a"});
  fathom_done({"run", "c.yaml", "--out", "b"});
  for (const std::string name : {"trajectory.tum", "frames.tum", "measurements.g2o"}) {
    EXPECT_EQ(bytes_of("a/" + name), bytes_of("b/" + name)) << name;
  }
}

TEST_F(Commands, CompareGivesOneLogToAll) {
  write("c.yaml", kSmallSurvey);
  const Ended ended = fathom_done({"compare", "c.yaml", "--out", "out"});
  const std::vector<std::string> names{"trajectory_iekf", "ekf", "ceres_pose_graph",
                                       "sparse_gauss_newton", "incremental_smoother"};
  for (const std::string& name : names) {
    EXPECT_THAT(ended.out, HasSubstr(name));
    EXPECT_THAT(bytes_of("out/table.txt"), HasSubstr(name));
    EXPECT_EQ(json_of("out/" + name + "/metrics.json").at("estimator"), name);
    EXPECT_EQ(bytes_of("out/" + name + "/measurements.g2o"), bytes_of("out/ekf/measurements.g2o"));
    EXPECT_LT(json_of("out/" + name + "/metrics.json").at("mean_position_error_m"), 0.02);
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

TEST_F(Commands, SolveOnARunsLogIsTheRunToTheLastBit) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"compare", "c.yaml", "--out", "out"});
  for (const std::string name : {"trajectory_iekf", "ekf", "ceres_pose_graph",
                                 "sparse_gauss_newton", "incremental_smoother"}) {
    fathom_done({"solve", "out/" + name + "/measurements.g2o", "--estimator", name, "--mode",
                 "incremental", "--out", "again"});
    const auto run = tum("out/" + name + "/trajectory.tum");
    const auto again = tum("again/trajectory.tum");
    ASSERT_EQ(run.size(), again.size());
    for (std::size_t k = 0; k < run.size(); ++k) {
      EXPECT_EQ(run[k].pose, again[k].pose) << name << " " << k;
      EXPECT_EQ(again[k].time_ns, static_cast<std::int64_t>(k) * 1'000'000'000);
    }
  }
}

TEST_F(Commands, ASimulationRunsFromDiskAsItDidBefore) {
  write("c.yaml", kSmallSurvey);
  const std::string folder = "it's a survey";  // a quote, to be written as YAML
  for (const Arguments& more :
       {Arguments{}, Arguments{"--set", "dataset.odometry.source=visual_odometry"}}) {
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
    EXPECT_EQ(ended.out.find("left out by max_per_keyframe") != std::string::npos, left_out > 0);
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

TEST_F(Commands, RegisterFindsTheMotionOfTwoFrames) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(ended.out, found, std::regex(R"(x +(-?[0-9.]+) m)"))) << ended.out;
  EXPECT_NEAR(std::stod(found[1]), 0.25, 0.03);  // 0.5 m/s, two pictures a second
  for (const char* line :
       {R"(^found: pose of B in the frame of A)", R"(\n  y +-?[0-9.]+ m +\+- 0\.)",
        R"(\n  heading +-?[0-9.]+ rad \+- 0\.)",
        R"(\n  rms of the pairs +0\.[0-9]+ m, [0-9.]+ pixels)",
        R"(\n  features +[0-9]+ in A, [0-9]+ in B)", R"(\n  matches +[0-9]+, each distinct)",
        R"(\n  nearest pairs +[0-9]+ agree, in [0-9]+ places)",
        R"(\n  other motions +[0-9]+ places at most)",
        R"(\n  by chance +(below 1e-300|[0-9.]+e-[0-9]+), at most 1e-07 is allowed)",
        R"(\n  scale +[01]\.[0-9]+ \+- 0\.[0-9]+, as the altitudes say)"}) {
    EXPECT_TRUE(std::regex_search(ended.out, std::regex(line))) << line << "\n" << ended.out;
  }
  expect_picture("out/matches_raw.png");
  expect_picture("out/matches_accepted.png");
  expect_picture("out/overlay.png");
}

TEST_F(Commands, RegisterSaysThatAltitudesMayBeWrong) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.11", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr(", not applied: the altitudes may be wrong\n"));
}

TEST_F(Commands, RegisterByInliersSaysHowManyAreNeeded) {
  write("c.yaml", std::string(kSmallSurvey) + "front_end.decision.method: inliers\n");
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr(" of them, 12 are needed; in 8 or more places, 8 are needed"));
  EXPECT_THAT(ended.out, Not(HasSubstr("by chance")));
}

TEST_F(Commands, RegisterWithoutAMatchIsStatusOne) {
  for (const std::string name : {"a.png", "b.png"}) {
    cv::Mat noise(120, 160, CV_8UC1);
    cv::RNG(name == "a.png" ? 1 : 2).fill(noise, cv::RNG::UNIFORM, 0, 255);
    cv::imwrite(path(name).string(), noise);
  }
  write("c.yaml", kSmallSurvey);
  const Ended ended = fathom({"register", "a.png", "b.png", "--config", "c.yaml", "--altitude-a",
                              "2", "--altitude-b", "2", "--out", "out"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("not found: "), HasSubstr("\n  nearest pairs"),
                               HasSubstr("\n  by chance"), Not(HasSubstr("scale"))));
  EXPECT_EQ(ended.err, "");
  expect_picture("out/matches_raw.png");
  expect_picture("out/matches_accepted.png");
  EXPECT_FALSE(std::filesystem::exists(path("out/overlay.png")));
}

TEST_F(Commands, ANumericalFailureIsStatusOneAndSaysSo) {
  // More information than a double holds beside the coordinates.
  write("huge.g2o",
        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
        "EDGE_SE2 0 2 -1 0 3 1e40 0 0 1e40 0 1e40\n");
  for (const std::string name : {"trajectory_iekf", "ekf", "ceres_pose_graph",
                                 "sparse_gauss_newton", "incremental_smoother"}) {
    const Ended ended = fathom({"solve", "huge.g2o", "--estimator", name, "--out", "out-" + name});
    EXPECT_EQ(ended.status, 1) << name << ended.out;
    const nlohmann::json metrics = json_of("out-" + name + "/metrics.json");
    EXPECT_EQ(metrics.at("outcome"), "numerical_failure") << metrics;
  }
}

TEST_F(Commands, SolveTakesModeStartAndGroundTruth) {
  write("g.g2o",
        "VERTEX_SE2 2 0 0 0\nVERTEX_SE2 5 1.5 0 0\nVERTEX_SE2 9 2.5 0 0\n"
        "EDGE_SE2 2 5 1 0 0 1 0 0 1 0 1\nEDGE_SE2 5 9 1 0 0 1 0 0 1 0 1\n"
        "EDGE_SE2 9 2 -2.3 0 0 1 0 0 1 0 1\n");
  write("truth.tum", "2 0 0 0 0 0 0 1\n5 1.1 0 0 0 0 0 1\n9 2.2 0 0 0 0 0 1\n");
  fathom_done({"solve", "g.g2o", "--mode", "batch", "--init", "file", "--ground-truth", "truth.tum",
               "--out", "out"});
  const nlohmann::json metrics = json_of("out/metrics.json");
  // By hand: three springs in a ring share the gap of 0.3 m; F = 3 · 0.1², from 0.5² + 0.2².
  EXPECT_NEAR(metrics.at("chi2").get<double>(), 0.03, 1e-9);
  EXPECT_NEAR(metrics.at("chi2_initial").get<double>(), 0.29, 1e-9);
  EXPECT_NEAR(metrics.at("mean_position_error_m").get<double>(), 0.0, 1e-6);
  EXPECT_EQ(metrics.at("mode"), "batch");
  EXPECT_EQ(tum("out/trajectory.tum")[2].time_ns, 9'000'000'000);
}

TEST_F(Commands, SolveSaysWhetherItFoundAMinimum) {
  write("g.g2o",
        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
        "EDGE_SE2 2 0 -2.3 0 0 1 0 0 1 0 1\n");
  const Ended ended =
      fathom_done({"solve", "g.g2o", "--estimator", "sparse_gauss_newton", "--out", "out"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("gradient "), HasSubstr(", a local minimum\n")));
  const nlohmann::json metrics = json_of("out/metrics.json");
  EXPECT_EQ(metrics.at("mode"), "batch");
  EXPECT_LT(metrics.at("gradient_norm").get<double>(), 1e-6);
  EXPECT_EQ(metrics.at("is_local_minimum"), 1);
  // By hand: three springs in a ring share the gap of 0.3 m.
  EXPECT_NEAR(metrics.at("chi2").get<double>(), 0.03, 1e-9);
}

TEST_F(Commands, SpoilRefusesWhatItCannotDo) {
  write("g.g2o", square_graph(160, 3));
  write("open.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const auto refused = [&](const std::string& graph, const std::string& share) {
    return refusal({"spoil", graph, "--share", share, "--out", "o.g2o"});
  };
  EXPECT_THAT(refused("g.g2o", "nan"), HasSubstr("--share: expected a number"));
  EXPECT_THAT(refused("g.g2o", "0.95"), HasSubstr("--share"));
  EXPECT_THAT(refused("open.g2o", "0.3"), HasSubstr("open.g2o: has no loop"));
}

TEST_F(Commands, SpoilAddsFalseLoopsThatSolveIsJudgedBy) {
  write("g.g2o", square_graph(160, 3));
  const auto spoilt = [&](const std::string& seed, const std::string& out) {
    return fathom_done({"spoil", "g.g2o", "--share", "0.25", "--kind", "grouped", "--group-size",
                        "2", "--seed", seed, "--out", out});
  };
  // 20 loops of the square, of which a third are added.
  EXPECT_THAT(spoilt("1", "a.g2o").out,
              AllOf(HasSubstr("7 false loops, grouped, among 27"), HasSubstr("a.false_loops.csv")));
  spoilt("1", "b.g2o");
  spoilt("2", "c.g2o");
  EXPECT_EQ(bytes_of("a.g2o"), bytes_of("b.g2o"));
  EXPECT_EQ(bytes_of("a.false_loops.csv"), bytes_of("b.false_loops.csv"));
  EXPECT_NE(bytes_of("a.g2o"), bytes_of("c.g2o"));
  const std::vector<std::string> solve{
      "solve", "a.g2o", "--estimator", "sparse_gauss_newton", "--false-loops", "a.false_loops.csv"};
  std::vector<std::string> robust = solve;
  robust.insert(robust.end(), {"--set", "estimator.loss=truncated", "--out", "robust"});
  EXPECT_THAT(fathom_done(robust).out, HasSubstr("0 of 7 false loops kept, 0 right ones lost"));
  EXPECT_EQ(json_of("robust/metrics.json").at("false_loops_kept"), 0);
  std::vector<std::string> plain = solve;
  plain.insert(plain.end(), {"--out", "plain"});
  EXPECT_THAT(fathom_done(plain).out, HasSubstr("7 of 7 false loops kept"));
}

TEST_F(Commands, SpoilRefusesWhatItWouldIgnore) {
  write("g.g2o", square_graph(160, 3));
  EXPECT_THAT(refusal({"spoil", "g.g2o", "--reach", "5", "--out", "a.g2o"}),
              HasSubstr("--reach: only --kind local"));
  EXPECT_THAT(refusal({"spoil", "g.g2o", "--group-size", "5", "--out", "a.g2o"}),
              HasSubstr("--group-size: only --kind grouped"));
}

TEST_F(Commands, EvaluateAgreesWithTheRun) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  const Ended ended = fathom_done({"evaluate", "out/trajectory.tum", "out/ground_truth.tum",
                                   "--step", "1", "--step", "3", "--distance", "1.5"});
  std::smatch found;
  ASSERT_TRUE(
      std::regex_search(ended.out, found, std::regex(R"(mean position error \(m\) +([0-9.e-]+))")));
  const double expected = json_of("out/metrics.json").at("mean_position_error_m");
  EXPECT_NEAR(std::stod(found[1]), expected, 1e-5 * expected);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("11 of 11 poses"), HasSubstr("3 poses"),
                               HasSubstr("1.50 m"), HasSubstr("alignment origin")));
}

TEST_F(Commands, EvaluateSaysOfASinglePoseThatItHasNoError) {
  write("estimate.tum", "0 1 2 0 0 0 0 1\n");
  write("reference.tum", "0 4 6 0 0 0 0 1\n1 5 6 0 0 0 0 1\n");
  for (const char* alignment : {"origin", "se2"}) {
    const std::string out =
        fathom_done({"evaluate", "estimate.tum", "reference.tum", "--alignment", alignment}).out;
    EXPECT_THAT(out, HasSubstr("no error can be given: alignment " + std::string(alignment)));
    EXPECT_THAT(out, Not(HasSubstr("mean position error")));
  }
  const std::vector<std::string> as_it_is{"evaluate", "estimate.tum", "reference.tum",
                                          "--alignment", "none"};
  EXPECT_TRUE(std::regex_search(fathom_done(as_it_is).out,
                                std::regex(R"(mean position error \(m\) +5\.0)")));
}

TEST_F(Commands, ListNamesEverythingWithItsOptions) {
  EXPECT_THAT(fathom_done({"list", "estimators"}).out,
              AllOf(HasSubstr("trajectory_iekf: "), HasSubstr("ekf: "),
                    HasSubstr("ceres_pose_graph: "), HasSubstr("estimator.gate_probability")));
  EXPECT_THAT(fathom_done({"list", "detectors"}).out,
              AllOf(HasSubstr("sift: "), HasSubstr("orb: "), HasSubstr("akaze: "),
                    HasSubstr("brisk: "), HasSubstr("front_end.ransac.max_error_m")));
  EXPECT_THAT(fathom_done({"list", "datasets"}).out,
              AllOf(HasSubstr("simulated: "), HasSubstr("image_folder: "), HasSubstr("g2o: "),
                    HasSubstr("dataset.altitude.base_m")));
  EXPECT_THAT(fathom_done({"list", "metrics"}).out,
              AllOf(HasSubstr("mean_position_error_m"), HasSubstr("rpe_N_keyframes_rad"),
                    HasSubstr("peak heap of the estimator")));
}

}  // namespace
}  // namespace fathom::test
