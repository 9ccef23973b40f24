// What a survey opens, and the noise that it adds to recorded dead reckoning.

#include "fathom/harness/survey.hpp"

#include <filesystem>
#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/core/random.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/motion_noise.hpp"
#include "fathom/geometry/covariance.hpp"
#include "harness/small_config.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::configured;
using test::input_error_of;
using test::kSmallSurvey;
using ::testing::HasSubstr;

// The noise of a study on what was recorded: exact motions and a known draw.
TEST(Record, NoiseIsAddedToRecordedDeadReckoning) {
  const Configuration simulation = configured(kSmallSurvey);
  const test::TemporaryFolder folder;
  write_image_folder(Survey(simulation).frames(), folder.path());
  const std::string text = "dataset: {type: image_folder, path: '" + folder.path().string() +
                           "'}\nseed: 5\ndataset.added_noise.";
  const Survey plain(configured(text + "sigma_x_m: 0\n"));
  const Survey noisy(configured(text + "covariance: [1.0e-4, 1.0e-5, 0, 1.0e-4, 0, 4.0e-4]\n"));
  Eigen::Matrix3d C;
  C << 1e-4, 1e-5, 0, 1e-5, 1e-4, 0, 0, 0, 4e-4;
  RandomStream stream(5, "added_noise", 0);
  const MotionNoise draws(C);
  for (std::size_t i = 1; i < 5; ++i) {
    const UncertainPose& before = *plain.frames().info(i).motion;
    const UncertainPose& after = *noisy.frames().info(i).motion;
    const Eigen::Vector3d expected = before.mean.vector() + draws.draw(stream);
    EXPECT_LT((after.mean.vector() - expected).norm(), 1e-15);
    EXPECT_LT((after.covariance - before.covariance - C).cwiseAbs().maxCoeff(), 1e-18);
  }
  EXPECT_FALSE(noisy.uses_visual_odometry());

  // Without recorded dead reckoning it is added to visual odometry.
  std::filesystem::remove_all(folder.path() / "mav0" / "odometry0");
  const Survey visual(configured(text + "sigma_x_m: 0\n"));
  const Survey noisy_visual(configured(text + "covariance: [0.01, 0, 0, 0.01, 0, 0.04]\n"));
  EXPECT_TRUE(noisy_visual.uses_visual_odometry());
  const Eigen::Matrix3d added =
      noisy_visual.frames().info(1).motion->covariance - visual.frames().info(1).motion->covariance;
  EXPECT_LT((added.diagonal() - Eigen::Vector3d(0.01, 0.01, 0.04)).norm(), 1e-15);
  EXPECT_NE(noisy_visual.frames().info(1).motion->mean, visual.frames().info(1).motion->mean);
}

TEST(Record, RefusesAddedNoiseThatIsNone) {
  const auto refused = [](const std::string& noise) {
    return input_error_of([&] {
      Survey(
          configured("dataset: {type: image_folder, path: /none}\ndataset.added_noise." + noise));
    });
  };
  EXPECT_THAT(refused("sigma_y_m: 0.1\n"), HasSubstr("dataset.added_noise.sigma_x_m: "));
  EXPECT_THAT(refused("covariance: [1, 1, 0, 1, 0, 1]\n"),
              HasSubstr("dataset.added_noise.covariance: is not positive definite"));
}

TEST(Survey, RefusesAGraph) {
  EXPECT_THAT(input_error_of([] { Survey(configured("dataset: {type: g2o, path: a}\n")); }),
              HasSubstr("a g2o graph has no pictures; use simulated or image_folder"));
}

}  // namespace
}  // namespace fathom
