// Pose graphs with priors, holes and several components through the program.

#include <cmath>
#include <sstream>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "apps/commands.hpp"
#include "apps/graphs.hpp"
#include "fathom/estimators/builtin.hpp"
#include "report/pixels.hpp"
#include "support/data.hpp"
#include "support/gdal.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// By hand: 1 m of dead reckoning between fixes that are 1.3 m apart, all of one weight, headings
// known: each of three springs gives 0.1 m, F = 3 · 0.1².
const std::string kSpring =
    "EDGE_SE2 4 7 1 0 0 1 0 0 1 0 1\nEDGE_PRIOR_SE2_XY 7 11.3 5 1 0 1\n"
    "EDGE_PRIOR_SE2 4 10 5 0 1 0 0 1 0 1\n";

TEST_F(Commands, SolveTakesPriorsAsTheyStand) {
  write("g.g2o", kSpring);
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const std::string& name = entry.name;
    for (const std::string mode : {"batch", "incremental"}) {
      if (mode == "batch" && !entry.can_batch) continue;
      const Ended ended = fathom_done(
          {"solve", "g.g2o", "--estimator", name, "--mode", mode, "--out", "out-" + name});
      const bool is_batch = mode == "batch";
      EXPECT_THAT(ended.out, HasSubstr(is_batch ? "2 absolute measurements, free start"
                                                : "1 absolute measurement, uncertain start"));
      const nlohmann::json metrics = json_of("out-" + name + "/metrics.json");
      EXPECT_NEAR(metrics.at("chi2").get<double>(), 0.03, 1e-9) << name << mode;
      EXPECT_NEAR(metrics.at("absolute_chi2").get<double>(), 0.02, 1e-6) << name << mode;
      EXPECT_EQ(metrics.at("absolute_used"), is_batch ? 2 : 1);
      EXPECT_EQ(metrics.at("degrees_of_freedom"), 2);
      const auto poses = tum("out-" + name + "/trajectory.tum");
      EXPECT_NEAR(poses[0].pose.x, 10.1, 1e-6) << name << mode;
      EXPECT_NEAR(poses[1].pose.x, 11.2, 1e-6) << name << mode;
    }
  }
}

TEST_F(Commands, SolveOnALogWithPriorsAndHolesIsTheSameToTheLastBit) {
  write("g.g2o", square_graph(250, 10) +
                     "EDGE_SE2 240 251 1 0 0 400 20 -5 300 10 900\n"  // 250 is not there
                     "EDGE_SE2 0 5 5 0 0 400 20 -5 300 10 900\n"
                     "EDGE_PRIOR_SE2 0 0.1 0.2 0.3 100 10 0 100 0 50\n"
                     "EDGE_PRIOR_SE2_XY 100 3 4 10 1 5\nEDGE_PRIOR_SE2 30 0 0 3 0 0 0 0 0 9\n");
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const std::string& name = entry.name;
    const Arguments solve{"--estimator", name, "--mode", "incremental"};
    const auto run = [&](const std::string& graph, const std::string& out) {
      Arguments all{"solve", graph, "--out", out};
      all.insert(all.end(), solve.begin(), solve.end());
      return fathom_done(all).out;
    };
    EXPECT_THAT(run("g.g2o", "a"), HasSubstr("2 absolute measurements, 1 hole, uncertain start"));
    run("a/measurements.g2o", "b");
    EXPECT_EQ(bytes_of("a/measurements.g2o"), bytes_of("b/measurements.g2o")) << name;
    EXPECT_EQ(bytes_of("a/trajectory.tum"), bytes_of("b/trajectory.tum")) << name;
    EXPECT_EQ(json_of("a/metrics.json").at("holes"), 1);
  }
}

TEST_F(Commands, AFilterWithoutAStartSaysWhatIsMissing) {
  write("g.g2o",
        "EDGE_SE2 4 7 1 0 0 1 0 0 1 0 1\nEDGE_PRIOR_SE2_XY 4 10 5 1 0 1\n"
        "EDGE_PRIOR_SE2 7 11 5 0 1 0 0 1 0 1\n");
  write("c.yaml", "dataset: {type: g2o, path: g.g2o}\nestimator: {type: ekf}\n");
  for (const Arguments& command :
       {Arguments{"solve", "g.g2o", "--estimator", "ekf"}, Arguments{"run", "c.yaml"}}) {
    EXPECT_THAT(refusal(command), AllOf(HasSubstr("g.g2o: "), HasSubstr("the first pose, 4, do "),
                                        HasSubstr("its heading"), HasSubstr("--mode batch")));
  }
  fathom_done({"solve", "g.g2o", "--estimator", "sparse_gauss_newton", "--out", "out"});
  fathom_done({"check", "g.g2o"});
}

const std::string kTwoComponents =
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 5 6 2 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2 6 7 2 0 0 1 0 0 1 0 1\n";

TEST_F(Commands, OneComponentOfSeveralIsTaken) {
  write("g.g2o", kTwoComponents);
  EXPECT_THAT(refusal({"solve", "g.g2o"}),
              AllOf(HasSubstr("g.g2o:2: the graph has 2 components"),
                    HasSubstr("(1: 2 poses, 0 to 1; 2: 3 poses, 5 to 7)"), HasSubstr("1|5")));
  const Ended checked = fathom({"check", "g.g2o"});
  EXPECT_EQ(checked.status, 2);
  EXPECT_THAT(checked.out, AllOf(ContainsRegex("components +2\n +1 +2 poses, 0 to 1\n +2 +3 poses"),
                                 HasSubstr("between 1 and 5\n")));
  fathom_done({"solve", "g.g2o", "--component", "2", "--out", "out"});
  EXPECT_EQ(tum("out/trajectory.tum")[0].time_ns, 5'000'000'000);
  EXPECT_EQ(json_of("out/run.json").at("configuration").at("dataset.component"), "2");
  fathom_done({"solve", "g.g2o", "--set", "dataset.component=1", "--out", "out"});
  EXPECT_EQ(tum("out/trajectory.tum").size(), 2U);
  write("c.yaml", "dataset: {type: g2o, path: g.g2o, component: 2}\n");
  fathom_done({"run", "c.yaml", "--out", "run"});
  EXPECT_EQ(tum("run/trajectory.tum").size(), 3U);
  EXPECT_THAT(refusal({"solve", "g.g2o", "--component", "3"}), HasSubstr("expected 1 to 2"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--component", "0"}), HasSubstr("--component"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--component", "1", "--set", "dataset.component=1"}),
              HasSubstr("--component says it already"));
}

// A batch solve has no use for the width of a hole, a filter has: two loops from 0 to 2 that differ
// by a metre, and a hole before 2.
TEST_F(Commands, AHoleIsAsWideAsTold) {
  write("g.g2o",
        "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 0 2 2 0 0 1 0 0 1 0 1\n"
        "EDGE_SE2 0 2 3 0 0 1 0 0 1 0 1\n");
  const auto x_of = [&](const std::string& sigma, const std::string& mode) {
    fathom_done({"solve", "g.g2o", "--estimator", "sparse_gauss_newton", "--mode", mode, "--set",
                 "dataset.gap_sigma_m=" + sigma, "--out", "out"});
    EXPECT_EQ(json_of("out/run.json").at("configuration").at("dataset.gap_sigma_m"), sigma);
    return tum("out/trajectory.tum")[2].pose.x;
  };
  EXPECT_NEAR(x_of("1", "batch"), 2.5, 1e-9);
  EXPECT_NEAR(x_of("50", "incremental"), 2.5, 1e-3);
  // By hand: the first loop bridges the hole, so that dead reckoning comes to 2 with σ² 1 + 1.
  EXPECT_NEAR(x_of("1", "incremental"), (2.0 / 2.0 + 2.0 + 3.0) / 2.5, 1e-9);
  EXPECT_THAT(refusal({"solve", "g.g2o", "--set", "dataset.gap_sigma_m=0"}),
              HasSubstr("dataset.gap_sigma_m"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--set", "dataset.gap_sigma_rads=5"}),
              HasSubstr("did you mean 'dataset.gap_sigma_rad'"));
}

TEST_F(Commands, CheckListsPriorsAndHoles) {
  write("g.g2o", kSpring + "EDGE_SE2 4 9 3 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(fathom_done({"check", "g.g2o"}).out,
              AllOf(HasSubstr("1, 1 hole"), ContainsRegex("components +1"),
                    HasSubstr("2: 0 of heading, 1 of position, 1 of both; they hold the graph"),
                    HasSubstr("at what a batch solve starts from"), Not(HasSubstr("no loops"))));
}

TEST_F(Commands, SpoilAndConvertKeepPriors) {
  write("g.g2o", square_graph(250, 10) + "EDGE_PRIOR_SE2 3 0.1 0.2 0.3 100 10 0 100 0 50\n");
  fathom_done({"spoil", "g.g2o", "--share", "0.3", "--out", "s.g2o"});
  const std::string spoilt = bytes_of("s.g2o");
  EXPECT_THAT(spoilt, AllOf(HasSubstr("EDGE_PRIOR_SE2 3 "), Not(HasSubstr("FIX"))));
  fathom_done({"convert", "g.g2o", "--to", "g2o", "--out", "c.g2o"});
  EXPECT_THAT(bytes_of("c.g2o"), HasSubstr("EDGE_PRIOR_SE2 3 0.1 0.2 0.3 100 10 0 100 0 50\n"));
  EXPECT_THAT(fathom_done({"convert", "g.g2o", "--to", "toro", "--out", "t.graph"}).out,
              HasSubstr("EDGE_PRIOR_SE2"));
  EXPECT_THAT(bytes_of("t.graph"), Not(HasSubstr("PRIOR")));
  write("bad.g2o", kTwoPoses + "EDGE_PRIOR_SE2 0 0 0 0 1 0 0 1 0 -1\n");
  EXPECT_THAT(refusal({"convert", "bad.g2o", "--to", "g2o", "--out", "b.g2o"}),
              HasSubstr("bad.g2o:4: "));
}

TEST_F(Commands, AStudyOverAGraphWithPriorsHasThemInItsTable) {
  write("g.g2o", kSpring + "EDGE_SE2 4 9 3 0 0 1 0 0 1 0 1\n");
  write("c.yaml",
        "dataset: {type: g2o, path: g.g2o}\nestimators: [{type: ekf}, {type: "
        "sparse_gauss_newton}]\nreport: {metrics: [chi2, absolute_used, holes]}\n");
  EXPECT_THAT(fathom_done({"compare", "c.yaml", "--out", "out"}).out,
              AllOf(HasSubstr("absolute used"), HasSubstr("holes")));
  EXPECT_EQ(json_of("out/ekf/metrics.json").at("absolute_used"), 1);
  EXPECT_NEAR(json_of("out/ekf/metrics.json").at("chi2_gap").get<double>(), 0.0, 1e-3);
}

// The graphs of the acceptance table (scripts/absolute_graphs), the smallest of them: F of both
// batch solvers against the script's own.
TEST_F(Commands, BatchSolvesAgreeWithAnIndependentOne) {
  FATHOM_REQUIRE_DATA("pose_graphs/ring.g2o");
  if (printed_by("/usr/bin/python3 -c 'import scipy, numpy; print(1)'") != "1\n") {
    GTEST_SKIP() << "Python has no SciPy here; 'scripts/setup.sh python' installs it";
  }
  const std::string graph = data_path("pose_graphs/ring.g2o").string();
  const std::string truth = data_path("pose_graphs/ring.groundtruth.tum").string();
  const std::string script = "cd " + path("").string() +
                             " && /usr/bin/python3 -B " FATHOM_SOURCE_DIR
                             "/scripts/absolute_graphs ";
  for (const std::string kind : {"pose", "fix", "compass", "semi", "mixed", "holes"}) {
    const bool is_holes = kind == "holes";
    printed_by(script +
               (is_holes ? "holes 10 " + graph : "make " + kind + " " + graph + " " + truth) +
               " g.g2o");
    const double expected = std::stod(printed_by(script + "solve g.g2o " + truth));
    for (const std::string name : {"sparse_gauss_newton", "ceres_pose_graph"}) {
      fathom_done({"solve", "g.g2o", "--estimator", name, "--out", "out"});
      EXPECT_NEAR(json_of("out/metrics.json").at("chi2").get<double>(), expected, 1e-6 * expected)
          << kind << " " << name;
    }
  }
}

// Dead reckoning begins where a weak prior says, 6 m off and turned by 1 rad; the fixes say better.
TEST_F(Commands, ThePictureHasTheTruthWhereTheEstimateIs) {
  std::string graph = "EDGE_PRIOR_SE2 0 5 -4 1 0.01 0 0 0.01 0 0.01\n";
  std::string truth;
  Pose pose;
  for (int k = 0; k < 5; ++k) {
    const Pose next = compose(pose, {8, 0, M_PI / 2});
    const auto text = [](const auto&... numbers) {
      std::ostringstream line;
      ((line << numbers << ' '), ...);
      return line.str() + "\n";
    };
    graph += text("EDGE_PRIOR_SE2_XY", k, pose.x, pose.y, "1e4 0 1e4");
    if (k < 4) graph += text("EDGE_SE2", k, k + 1, 8, 0, M_PI / 2, "1e4 0 0 1e4 0 1e4");
    truth += text(k, pose.x, pose.y, "0 0 0", std::sin(pose.theta / 2), std::cos(pose.theta / 2));
    pose = next;
  }
  write("g.g2o", graph);
  write("truth.tum", truth);
  fathom_done({"solve", "g.g2o", "--estimator", "sparse_gauss_newton", "--ground-truth",
               "truth.tum", "--out", "out"});
  EXPECT_NEAR(tum("out/dead_reckoning.tum")[0].pose.x, 5.0, 1e-9);
  EXPECT_NEAR(tum("out/trajectory.tum")[0].pose.x, 0.0, 0.01);
  const cv::Mat whole = read_picture(path("out/trajectory.png"));
  const cv::Mat picture = whole.rowRange(125, whole.rows - 110).clone();
  const cv::Mat truth_line = where(picture, tint(palette::black, 0.45));
  cv::Mat beside;
  cv::dilate(where(picture, estimator_style(0).colour), beside, cv::Mat::ones(11, 11, CV_8U));
  ASSERT_GT(cv::countNonZero(truth_line), 1000);
  EXPECT_GT(cv::countNonZero(truth_line & beside), 0.9 * cv::countNonZero(truth_line));
}

}  // namespace
}  // namespace fathom::test
