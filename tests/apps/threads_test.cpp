// Cost is measured on one thread, whatever the libraries below would like. Threads are counted
// where they are started, so that neither speed nor load matters.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"

namespace fathom::test {
namespace {

class Threads : public CommandLine {
 protected:
  void SetUp() override {
    if (std::string(FATHOM_TEST_PRELOADED).empty()) {
      GTEST_SKIP() << "a sanitizer counts threads itself and lets nobody in before it";
    }
    surroundings_.environment = {{"LD_PRELOAD", FATHOM_TEST_PRELOADED},
                                 {"FATHOM_THREAD_COUNT", path("threads")}};
  }

  /// How many threads a command starts beside its first.
  std::size_t started_by(const Arguments& arguments) const {
    std::filesystem::remove(path("threads"));
    fathom_done(arguments);
    return read_file(path("threads")).size();
  }
};

TEST_F(Threads, NoPoolIsStarted) {
  EXPECT_EQ(started_by({"--version"}), 0u);
  EXPECT_EQ(started_by({"list", "estimators"}), 0u);
}

TEST_F(Threads, AGraphSolveKeepsToOne) {
  write("g.g2o", square_graph(3000, 3));
  for (const std::string estimator : {"ceres_pose_graph", "sparse_gauss_newton"}) {
    EXPECT_EQ(started_by({"solve", "g.g2o", "--estimator", estimator, "--out", "out"}), 0u)
        << estimator;
  }
}

TEST_F(Threads, AreAsManyAsTheEstimatorIsGiven) {
  write("g.g2o", square_graph(3000, 3));
  for (const auto& [threads, started] : {std::pair{"1", 0u}, std::pair{"3", 2u}}) {
    EXPECT_EQ(started_by({"solve", "g.g2o", "--mode", "batch", "--estimator", "sparse_gauss_newton",
                          "--set", std::string("estimator.threads=") + threads, "--out", "out"}),
              started);
  }
}

TEST_F(Threads, FiltersKeepToOne) {
  write("g.g2o", square_graph(900, 4));
  for (const std::string estimator : {"trajectory_iekf", "ekf", "incremental_smoother"}) {
    EXPECT_EQ(started_by({"solve", "g.g2o", "--estimator", estimator, "--out", "out"}), 0u)
        << estimator;
  }
}

// The count itself: a study with two jobs does start a thread.
TEST_F(Threads, AreCounted) {
  write("s.yaml", R"(
dataset:
  type: simulated
  world: {metres_per_pixel: 0.02}
  mission: {type: sweep, legs: 2, leg_length_m: 2, leg_spacing_m: 1}
  camera: {width: 80, height: 60, fx: 60, fy: 60}
estimators: [{type: ekf}]
trials: 2
)");
  const Arguments study{"compare", "s.yaml", "--no-cache", "--quiet", "--no-mosaic"};
  Arguments by_two = study;
  by_two.insert(by_two.end(), {"--jobs", "2", "--out", "out"});
  EXPECT_GT(started_by(by_two), 0u);
}

}  // namespace
}  // namespace fathom::test
