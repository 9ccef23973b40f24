// Pictures told apart without their pixels, and floors that wait until they are needed.

#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "same_picture.hpp"
#include "small_survey.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using test::full_survey;
using test::same;
using test::small_survey;

TEST(LazyFloor, IsDrawnForTheFirstPictureAlone) {
  const SimulatedSurvey survey(full_survey(), 5);
  survey.picture_id(0);
  const SimulatedSurvey again = survey.remeasured({}, 6, 1);
  EXPECT_FALSE(survey.is_world_drawn());
  std::vector<std::thread> threads;
  std::vector<cv::Mat> pictures(4);
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] { pictures[t] = (t % 2 == 0 ? survey : again).image(3); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(survey.is_world_drawn());
  EXPECT_TRUE(again.is_world_drawn());
  EXPECT_EQ(&survey.world(), &again.world());
  for (const cv::Mat& picture : pictures) EXPECT_TRUE(same(picture, pictures[0]));
  EXPECT_TRUE(same(pictures[0], SimulatedSurvey(full_survey(), 5).image(3)));
}

TEST(LazyFloor, OutlivesTheSurveyItWasMadeFor) {
  const SimulatedSurvey survey = SimulatedSurvey(small_survey(), 5).remeasured({}, 6, 1);
  EXPECT_TRUE(same(survey.image(2), SimulatedSurvey(small_survey(), 5).image(2)));
}

void expect_same_measurements(const SimulatedSurvey& a, const SimulatedSurvey& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.has_odometry(), b.has_odometry());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.info(i).time_ns, b.info(i).time_ns);
    EXPECT_EQ(a.info(i).altitude_m, b.info(i).altitude_m);
    EXPECT_EQ(a.info(i).ground_truth, b.info(i).ground_truth);
    EXPECT_EQ(a.picture_id(i), b.picture_id(i));
    ASSERT_EQ(a.info(i).motion.has_value(), b.info(i).motion.has_value());
    if (!a.info(i).motion) continue;
    EXPECT_EQ(a.info(i).motion->mean, b.info(i).motion->mean);
    EXPECT_EQ(a.info(i).motion->covariance, b.info(i).motion->covariance);
  }
}

TEST(Remeasured, IsWhatTheConstructorWouldMeasure) {
  const SimulatedSurveyOptions options = full_survey();
  const SimulatedSurvey survey(options, 9, 0);
  expect_same_measurements(survey.remeasured(options.odometry, 9, 4),
                           SimulatedSurvey(options, 9, 4));
  SimulatedSurveyOptions visual = options;
  visual.odometry.source = OdometrySource::kVisualOdometry;
  expect_same_measurements(survey.remeasured(visual.odometry, 9, 1), SimulatedSurvey(visual, 9, 1));
}

TEST(Remeasured, AnotherNoiseSeedHasOtherMotionsInTheSameSurvey) {
  const SimulatedSurvey survey(full_survey(), 9);
  const SimulatedSurvey other = survey.remeasured(full_survey().odometry, 10, 0);
  EXPECT_EQ(other.info(1).altitude_m, survey.info(1).altitude_m);
  EXPECT_NE(other.info(1).motion->mean, survey.info(1).motion->mean);
  EXPECT_EQ(other.picture_id(1), survey.picture_id(1));
  // The noise is that of a survey with that seed, over another floor.
  const SimulatedSurvey seeded(full_survey(), 10);
  EXPECT_EQ(other.info(1).motion->mean, seeded.info(1).motion->mean);
  EXPECT_NE(other.picture_id(1), seeded.picture_id(1));
}

TEST(Remeasured, RefusesWhatTheConstructorRefuses) {
  const SimulatedSurvey survey(small_survey(), 1);
  for (const double sigma_m : {-1.0, 0.0}) {
    OdometryOptions odometry;
    odometry.sigma_x_m = sigma_m;
    const std::string refused = test::input_error_of([&] { survey.remeasured(odometry, 1, 0); });
    EXPECT_EQ(refused.find("dataset.odometry.sigma_x_m: "), 0U) << sigma_m;
  }
}

// Each of these changes pixels, so each must change the number.
TEST(PictureId, OfASimulationCountsAllThatMakesThePixels) {
  std::set<std::uint64_t> different;
  const SimulatedSurvey survey(full_survey(), 1);
  for (std::size_t i = 0; i < survey.size(); ++i) different.insert(survey.picture_id(i));
  EXPECT_EQ(different.size(), survey.size());
  std::size_t count = survey.size();
  const auto with = [&](auto change, std::uint64_t seed = 1) {
    SimulatedSurveyOptions options = full_survey();
    change(options);
    different.insert(SimulatedSurvey(options, seed).picture_id(1));
    EXPECT_EQ(different.size(), ++count);
  };
  with([](auto&) {}, 2);
  with([](auto& o) { o.world.metres_per_pixel = 0.012; });
  with([](auto& o) { o.world.heading_rad = 0.1; });
  with([](auto& o) { o.altitude.base_m = 2.1; });
  with([](auto& o) { o.mission.speed_m_s = 0.51; });
  with([](auto& o) { o.mission.legs = 3; });  // a larger floor
  with([](auto& o) { o.camera.base.width = 66; });
  with([](auto& o) { o.camera.base.fx = 50.5; });
  with([](auto& o) { o.camera.cy = 24.0; });
  with([](auto& o) { o.camera.distortion[4] = 0.004; });
  with([](auto& o) { o.camera.base.mount_yaw_rad = 0.41; });
  with([](auto& o) { o.world.floor = FloorKind::mud; });
  with([](auto& o) { o.world.relief_m = 0.05; });
  with([](auto& o) { o.attitude.roll_sigma_rad = 0.02; });
  with([](auto& o) { o.attitude.pitch_sigma_rad = 0.02; });
  with([](auto& o) { o.effects.water.attenuation_per_m = 0.3; });
  with([](auto& o) { o.effects.water.caustics = 0.2; });
  with([](auto& o) { o.effects.water.particles = 9; });
  with([](auto& o) { o.effects.camera.corner_light = 0.4; });
  with([](auto& o) { o.effects.camera.contrast = 0.4; });
  with([](auto& o) { o.effects.camera.motion_blur_px = 4.0; });
  with([](auto& o) { o.effects.camera.noise_sigma = 4.0; });
  with([](auto& o) { o.effects.camera.colour_cast = {1.0, 1.0, 0.9}; });
}

TEST(PictureId, OfASimulationDoesNotCountWhatIsMeasured) {
  SimulatedSurveyOptions other = full_survey();
  other.odometry = {};
  other.altitude.altimeter_sigma_m = 0.02;
  SimulatedSurveyOptions murky = full_survey();
  murky.effects.camera.noise_sigma = 3.0;
  murky.attitude.roll_sigma_rad = 0.02;
  other.effects = murky.effects;
  other.attitude = murky.attitude;
  const SimulatedSurvey a(murky, 1, 0);
  const SimulatedSurvey b(other, 1, 3);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a.picture_id(i), b.picture_id(i));
  EXPECT_TRUE(same(a.image(2), b.image(2)));
}

TEST(PictureId, OverAGivenPictureCountsItsContentAndNotItsName) {
  const test::TemporaryFolder folder;
  const cv::Mat floor(600, 600, CV_8UC1, cv::Scalar(90));
  cv::Mat other = floor.clone();
  other.at<uchar>(3, 4) = 91;
  const auto id = [&](const char* name, const cv::Mat& picture, std::uint64_t seed) {
    SimulatedSurveyOptions options = small_survey();
    options.world.picture = (folder / name).string();
    EXPECT_TRUE(test::write_picture(options.world.picture, picture));
    return SimulatedSurvey(options, seed).picture_id(0);
  };
  EXPECT_EQ(id("a.png", floor, 1), id("b.png", floor, 2));
  EXPECT_NE(id("a.png", floor, 1), id("b.png", other, 1));
}

TEST(PictureId, OfAFolderIsThatOfTheFilesBytes) {
  const test::FolderFixture fixture;
  const auto folder = fixture.write();
  const auto pictures = fixture.mav0() / "cam0" / "data";
  test::write_picture(pictures / "c.png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(7)));
  const ImageFolder a(folder);
  // The fixture's pictures are alike.
  EXPECT_EQ(a.picture_id(0), a.picture_id(1));
  EXPECT_NE(a.picture_id(0), a.picture_id(2));
  const ImageFolder b(folder);
  EXPECT_EQ(a.picture_id(2), b.picture_id(2));
}

TEST(PictureId, OfAFolderReadsOnceAndDecodesNothing) {
  const test::FolderFixture fixture;
  const ImageFolder frames(fixture.write());
  const auto file = fixture.mav0() / "cam0" / "data" / "b.png";
  std::ofstream(file) << "no picture";
  const std::uint64_t id = frames.picture_id(1);
  EXPECT_NE(id, frames.picture_id(0));
  std::filesystem::remove(file);
  EXPECT_EQ(frames.picture_id(1), id);
}

TEST(PictureId, OfAFolderMayBeAskedForByManyThreadsAndAgainAfterAFailure) {
  const test::FolderFixture fixture;
  const ImageFolder frames(fixture.write());
  const auto file = fixture.mav0() / "cam0" / "data" / "b.png";
  std::filesystem::rename(file, fixture.mav0() / "away");
  EXPECT_NE(test::input_error_of([&] { frames.picture_id(1); }).find("b.png: cannot be opened"),
            std::string::npos);
  std::filesystem::rename(fixture.mav0() / "away", file);
  std::vector<std::uint64_t> ids(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] { ids[t] = frames.picture_id(1); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::uint64_t id : ids) EXPECT_EQ(id, frames.picture_id(0));
}

}  // namespace
}  // namespace fathom
