// Mosaics, through the real program.

#include <filesystem>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"
#include "harness/small_config.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MosaicCommand : public CommandLine {
 protected:
  cv::Mat picture(const std::string& name) const {
    return read_picture(path(name), cv::IMREAD_UNCHANGED);
  }
  std::string bytes_of(const std::string& name) const { return read_file(path(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }

  // Share of the pixels that any picture shows.
  static double covered(const cv::Mat& mosaic) {
    return 1.0 - cv::countNonZero(mosaic == 255) / static_cast<double>(mosaic.total());
  }
};

TEST_F(MosaicCommand, ARunWritesTheMosaicOfItsEstimate) {
  write("c.yaml", kSmallSurvey);
  EXPECT_THAT(fathom_done({"run", "c.yaml", "--out", "out"}).out, HasSubstr("mosaic.png: "));
  const cv::Mat mosaic = picture("out/mosaic.png");
  ASSERT_EQ(mosaic.type(), CV_8U);
  const nlohmann::json where = json_of("out/mosaic.json");
  const double metres_per_pixel = where.at("metres_per_pixel");
  EXPECT_NEAR(metres_per_pixel, 2.0 / 130.5, 0.001);  // altitude over focal length
  // The loop of 2.4 m by 1.6 m, and a footprint of 2.5 m by 1.8 m, more in the corners, where it
  // turns.
  EXPECT_NEAR(mosaic.rows * metres_per_pixel, 2.4 + 2.8, 0.6);
  EXPECT_NEAR(mosaic.cols * metres_per_pixel, 1.6 + 2.8, 0.6);
  EXPECT_GT(where.at("x_of_top_left_m"), 1.2);
  EXPECT_GT(where.at("y_of_top_left_m"), 1.6);
  EXPECT_GT(covered(mosaic), 0.65);

  const Ended again = fathom_done({"mosaic", "out", "--blend", "seams", "--out", "again"});
  EXPECT_THAT(again.out,
              AllOf(HasSubstr("33 of 33 frames have a pose"), HasSubstr("again/mosaic.png")));
  EXPECT_EQ(bytes_of("again/mosaic.png"), bytes_of("out/mosaic.png"));
  EXPECT_EQ(bytes_of("again/mosaic.json"), bytes_of("out/mosaic.json"));
  // For measuring it hides nothing.
  fathom_done({"mosaic", "out", "--out", "measured"});
  EXPECT_EQ(where.at("blend"), "seams");
  EXPECT_EQ(json_of("measured/mosaic.json").at("blend"), "feather");
  EXPECT_NE(bytes_of("measured/mosaic.png"), bytes_of("out/mosaic.png"));
}

TEST_F(MosaicCommand, TakesAnotherTrajectoryAndResolution) {
  write("c.yaml", std::string(kSmallSurvey) + kVisualOdometry);
  fathom_done({"run", "c.yaml", "--out", "out", "--seed", "5"});
  // Keyframes alone will do.
  EXPECT_THAT(fathom_done({"mosaic", "out", "--trajectory", "out/trajectory.tum"}).out,
              AllOf(HasSubstr("11 of 33 frames"), HasSubstr("runs/out-trajectory/mosaic.png")));
  EXPECT_TRUE(exists("runs/out-trajectory/mosaic.json"));
  fathom_done({"mosaic", "out", "--trajectory", "out/dead_reckoning.tum", "--out", "other",
               "--resolution", "0.05", "--quiet"});
  EXPECT_EQ(json_of("other/mosaic.json").at("metres_per_pixel"), 0.05);
  EXPECT_GT(covered(picture("other/mosaic.png")), 0.6);
}

// The run's own map files hold its loops and the spread of its poses.
TEST_F(MosaicCommand, IntoTheFolderOfItsRunGoesAMosaicOfItsEstimateAlone) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  write("out/loops.geojson", "of the run");
  const std::string footprints = bytes_of("out/footprints.csv");
  fathom_done({"mosaic", "out", "--resolution", "0.05", "--out", "out"});
  EXPECT_EQ(json_of("out/mosaic.json").at("metres_per_pixel"), 0.05);
  EXPECT_EQ(bytes_of("out/loops.geojson"), "of the run");
  EXPECT_EQ(bytes_of("out/footprints.csv"), footprints);
  const std::string mosaic = bytes_of("out/mosaic.png");
  EXPECT_THAT(refusal({"mosaic", "out", "--trajectory", "out/dead_reckoning.tum", "--out", "out"}),
              HasSubstr("out: is the folder of a run"));
  EXPECT_EQ(bytes_of("out/mosaic.png"), mosaic);
}

TEST_F(MosaicCommand, OfARunFromDiskThatHasMoved) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  fathom_done({"run", "data/run.yaml", "--out", "out"});
  std::filesystem::rename(path("data"), path("moved"));
  EXPECT_THAT(refusal({"mosaic", "out"}), HasSubstr("data"));
  fathom_done(
      {"mosaic", "out", "--set", "dataset.path=moved", "--blend", "seams", "--out", "again"});
  EXPECT_EQ(bytes_of("again/mosaic.png"), bytes_of("out/mosaic.png"));
}

TEST_F(MosaicCommand, ComparedEstimatorsHaveOneEach) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"compare", "c.yaml", "--out", "out"});
  for (const std::string name : {"trajectory_iekf", "ekf", "ceres_pose_graph"}) {
    EXPECT_GT(covered(picture("out/" + name + "/mosaic.png")), 0.65) << name;
    fathom_done({"mosaic", "out/" + name, "--blend", "seams", "--out", "again"});
    EXPECT_EQ(bytes_of("again/mosaic.png"), bytes_of("out/" + name + "/mosaic.png")) << name;
  }
  fathom_done({"compare", "c.yaml", "--out", "none", "--no-mosaic"});
  EXPECT_FALSE(exists("none/ekf/mosaic.png"));
}

TEST_F(MosaicCommand, WithoutOneAnOlderOneIsRemoved) {
  write("c.yaml", kSmallSurvey);
  write("out/mosaic.png", "old");
  write("out/mosaic.json", "old");
  const Ended ended = fathom_done({"run", "c.yaml", "--out", "out", "--no-mosaic"});
  EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("mosaic")));
  EXPECT_FALSE(exists("out/mosaic.png"));
  EXPECT_FALSE(exists("out/mosaic.json"));
}

TEST_F(MosaicCommand, Refuses) {
  write("c.yaml", kSmallSurvey);
  write("g.g2o", kTwoPoses);
  write("late.tum", "500 0 0 0 0 0 0 1\n501 1 0 0 0 0 0 1\n");
  write("far.tum", "0 0 0 0 0 0 0 1\n1 1e9 0 0 0 0 0 1\n");
  write("nan.tum", "0 nan 0 0 0 0 0 1\n");
  write("empty.tum", "# nothing\n");
  write("broken/run.json", "{");
  fathom_done({"run", "c.yaml", "--out", "out"});
  fathom_done({"solve", "g.g2o", "--out", "graph"});
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"nowhere"}, "nowhere/run.json: is not there; expected the folder of a run, or of one"},
      {{"broken"}, "has no configuration"},
      {{"graph"}, "graph/run.json: the run was over a pose graph, which has no pictures"},
      {{"out", "--trajectory", "none.tum"}, "none.tum"},
      {{"out", "--trajectory", "late.tum"}, "late.tum: no pose is within 0.01"},
      {{"out", "--trajectory", "empty.tum"}, "empty.tum: no pose is within 0.01"},
      {{"out", "--trajectory", "nan.tum"}, "nan.tum:1"},
      {{"out", "--trajectory", "far.tum"}, "specks"},
      {{"out", "--resolution", "0"}, "--resolution: expected a number > 0"},
      {{"out", "--resolution", "5"}, "too coarse"},
      {{"out", "--set", "estimator.type=ekf"}, "estimator.type: a mosaic depends on dataset"},
      {{"out", "--set", "dataset.nonsense=1"}, "unknown key 'dataset.nonsense'"}};
  for (auto [arguments, message] : cases) {
    arguments.insert(arguments.begin(), "mosaic");
    arguments.insert(arguments.end(), {"--out", "new"});
    EXPECT_THAT(refusal(arguments), HasSubstr(message));
  }
}

}  // namespace
}  // namespace fathom::test
