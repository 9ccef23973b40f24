// A folder of plain pictures, with a configuration and without.

#include <algorithm>
#include <vector>

#include <gmock/gmock.h>

#include "apps/your_survey.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

using PlainPictures = YourSurvey;

// The survey's pictures as a camera would have left them, and a height that is about right.
TEST_F(PlainPictures, CloseTheirLoops) {
  simulate("data");
  fs::create_directory(path("pictures"));
  std::vector<fs::path> taken;
  for (const auto& file : fs::directory_iterator(path("data/mav0/cam0/data"))) {
    taken.push_back(file.path());
  }
  const auto time_of = [](const fs::path& file) { return std::stoll(file.stem().string()); };
  std::ranges::sort(taken, {}, time_of);
  for (std::size_t i = 0; i < taken.size(); ++i) {
    const cv::Mat picture = read_picture(taken[i].string(), cv::IMREAD_GRAYSCALE);
    write_picture(path("pictures/shot" + std::to_string(i) + ".jpg").string(), picture);
  }
  write("run.yaml",
        "dataset:\n  type: pictures\n  path: pictures\n  altitude_m: 2.0\n"
        "  camera: {focal_px: 130}\nestimator: {type: incremental_smoother}\n");
  const Ended ended = fathom_done({"run", "run.yaml", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr("dead reckoning by visual odometry"));
  // Without a configuration what the pictures do not say is asked for.
  EXPECT_THAT(refusal({"run", "pictures"}), HasSubstr("dataset.camera.focal_px"));
  EXPECT_THAT(refusal({"check", "pictures"}), HasSubstr("dataset.camera.focal_px"));
  const Arguments given{"--set", "dataset.altitude_m=2.0", "--set", "dataset.camera.focal_px=130"};
  const auto with_given = [&given](Arguments all) {
    all.insert(all.end(), given.begin(), given.end());
    return all;
  };
  const Ended checked = fathom_done(with_given({"check", "pictures"}));
  EXPECT_THAT(checked.out, AllOf(HasSubstr("what 'fathom run pictures' will find"),
                                 HasSubstr("frames: "), HasSubstr("160 x 120 pixels, f 130")));
  // What is wrong with them is said as of an image folder.
  std::string altitudes;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    altitudes += "shot" + std::to_string(i) + (i == 3 ? ".jpg,20\n" : ".jpg,2\n");
  }
  write("altitudes.csv", altitudes);
  EXPECT_THAT(fathom_done({"check", "pictures", "--set", "dataset.altitudes=altitudes.csv", "--set",
                           "dataset.camera.focal_px=130"})
                  .out,
              HasSubstr("warning: altitude changes by more than half from the frame before: 2"));
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

}  // namespace
}  // namespace fathom::test
