#include "fathom/datasets/folder_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "small_survey.hpp"
#include "support/data.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FolderSummary, StatesWhatIsThere) {
  const FolderFixture fixture;
  const FolderSummary summary = summarise_frames(ImageFolder(fixture.write()));
  EXPECT_THAT(summary.facts, Contains("frames: 3 in 2e-06 s"));
  EXPECT_THAT(summary.facts, Contains(HasSubstr("8 x 6 pixels, f 10, 10.4, centre 3.5, 2.5")));
  // f = √(10 · 10.4) = 10.198 pixels.
  EXPECT_THAT(summary.facts, Contains("altitude: 2 to 3 m, 196.1 to 294.2 mm per pixel, sigma not "
                                      "stated"));
  EXPECT_THAT(summary.facts, Contains("odometry: path of 3 m"));
  EXPECT_THAT(summary.facts, Contains("ground truth: 3 of 3 frames"));
}

TEST(FolderSummary, SaysHowExactAltitudesAre) {
  FolderFixture fixture;
  fixture.files["altimeter0/sensor.yaml"] = "sigma_relative: 0.01\n";
  const FolderSummary summary = summarise_frames(ImageFolder(fixture.write()));
  EXPECT_THAT(summary.facts, Contains(HasSubstr("mm per pixel, sigma 0.02 to 0.03 m")));
  fixture.files["altimeter0/sensor.yaml"] = "sigma_absolute: 0.02\n";
  EXPECT_THAT(summarise_frames(ImageFolder(fixture.write())).facts,
              Contains(HasSubstr("mm per pixel, sigma 0.02 m")));
}

// Straight flight at constant altitude: the overlap is one less the step over the footprint's
// length, 0.25 m over 2 m · 48 / 52 = 1.846 m.
TEST(FolderSummary, OverlapIsThatOfTheFootprints) {
  SimulatedSurveyOptions options = test::small_survey();
  options.mission.type = MissionType::kWaypoints;
  options.mission.waypoints_m = {0, 0, 3, 0};
  options.altitude.altimeter_sigma_m = 0.0;
  options.odometry.sigma_x_m = options.odometry.sigma_y_m = options.odometry.sigma_theta_rad = 1e-9;
  const FolderSummary summary = summarise_frames(SimulatedSurvey(options, 1));
  EXPECT_THAT(summary.facts,
              Contains("overlap of consecutive pictures: median 86.5 %, least 86.5 %"));
  EXPECT_THAT(summary.warnings, IsEmpty());
}

TEST(FolderSummary, WarnsOfWhatLooksWrong) {
  FolderFixture fixture;
  fixture.files["cam0/data.csv"] = "0,a.png\n1000,b.png\n2000,c.png\n3000,a.png\n9000,b.png\n";
  fixture.files["altimeter0/data.csv"] = "0,2\n1000,2\n2000,4\n9000,4\n";
  fixture.files["odometry0/data.csv"] =
      "0,0,0,0,1,1,1\n1000,1,0,0,1,1,1\n2000,1,90,0,1,1,1\n9000,1,90,0,1,1,1\n";
  fixture.files["state_groundtruth_estimate0/data.csv"] = "0,0,0,0,1,0,0,0\n9000,1,0,0,1,0,0,0\n";
  const auto root = fixture.write();
  test::write_picture(fixture.mav0() / "cam0/data/c.png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(3)));
  const FolderSummary summary = summarise_frames(ImageFolder(root));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("time gaps")));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("altitude changes by more than half")));
  EXPECT_THAT(summary.warnings,
              Contains(HasSubstr("no overlap with the picture before: 1 (frame 2)")));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("odometry ends further from ground truth")));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("hardly any contrast: 1 (frame 2)")));
}

TEST(FolderSummary, AnUnreadablePictureIsAWarning) {
  const FolderFixture fixture;
  const auto root = fixture.write();
  std::ofstream(fixture.mav0() / "cam0/data/b.png", std::ios::trunc) << "broken";
  EXPECT_THAT(summarise_frames(ImageFolder(root)).faults, ElementsAre(HasSubstr("b.png: is no")));
}

TEST(FolderSummary, WithoutOdometryOrTruth) {
  FolderFixture fixture;
  fixture.files.erase("odometry0/data.csv");
  fixture.files["state_groundtruth_estimate0/data.csv"] = "0,0,0,0,1,0,0,0\n1000,1,0,0,1,0,0,0\n";
  const FolderSummary summary = summarise_frames(ImageFolder(fixture.write()));
  EXPECT_THAT(summary.facts, Contains("odometry: none"));
  EXPECT_THAT(summary.facts, Contains("ground truth: 2 of 3 frames"));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("only where every keyframe has it")));
}

TEST(FolderSummary, RealPicturesRaiseNoWarning) {
  FATHOM_REQUIRE_DATA("copr");
  const FolderSummary summary = summarise_frames(ImageFolder(test::data_path("copr")));
  EXPECT_THAT(summary.warnings, IsEmpty());
  EXPECT_THAT(summary.facts, Contains("frames: 38 in 74 s"));
}

}  // namespace
}  // namespace fathom
