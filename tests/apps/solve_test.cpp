// solve: the log of a run again, graphs worked out by hand, and one that cannot be solved.

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "apps/graphs.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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

// As check does; it is no failure.
TEST_F(Commands, SolveSaysWhereMeasurementsDoNotFitEachOther) {
  const std::string square = square_graph(250, 10);
  write("square.g2o", square);
  write("spoilt.g2o", square + "EDGE_SE2 200 202 9 -4 1 400 20 -5 300 10 900\n");
  EXPECT_THAT(fathom_done({"solve", "square.g2o"}).out, Not(HasSubstr("warning: ")));
  const std::string warning = "the measurements do not fit each other: F per degree of freedom is ";
  EXPECT_THAT(fathom_done({"solve", "spoilt.g2o", "--out", "out"}).out,
              HasSubstr("\nwarning: " + warning));
  EXPECT_THAT(json_of("out/run.json").at("remarks").dump(), HasSubstr(warning));
  EXPECT_THAT(fathom_done({"solve", "spoilt.g2o", "--out", "out", "--quiet"}).out, IsEmpty());
}

}  // namespace
}  // namespace fathom::test
