// Readings of an image folder that their neighbours contradict.

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A reading every 200 ns from 0 to 2000 ns; the pictures are numbers 0, 5 and 10.
std::string rows(const std::vector<std::string>& readings) {
  std::string text = "# a comment\n";
  for (std::size_t i = 0; i < readings.size(); ++i) {
    text += std::to_string(200 * i) + "," + readings[i] + "\n";
  }
  return text;
}

std::vector<std::string> eleven(const std::string& reading) {
  return std::vector<std::string>(11, reading);
}

ImageFolder with_altitudes(const std::vector<std::string>& readings,
                           const std::string& yaml = "sigma_absolute: 0\n") {
  FolderFixture fixture;
  fixture.files["altimeter0/data.csv"] = rows(readings);
  fixture.files["altimeter0/sensor.yaml"] = yaml;
  return ImageFolder(fixture.write());
}

TEST(AltimeterOutliers, AnEchoOfFiftyMetresIsLeftOut) {
  std::vector<std::string> readings = eleven("2");
  readings[5] = "50";
  const ImageFolder folder = with_altitudes(readings);
  EXPECT_NEAR(folder.info(1).altitude_m, 2.0, 1e-12);
  // Of readings that are all alike 1 %, over two intervals.
  EXPECT_NEAR(folder.info(1).altitude_sigma_m, 0.02 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(folder.info(0).altitude_sigma_m, 0.0);
  EXPECT_THAT(folder.remarks(),
              ElementsAre("altimeter0: 1 of 11 readings left out (first: line 7, 50 m where its "
                          "neighbours have 2 m); 'outliers: keep' in its sensor.yaml keeps them"));
  const ImageFolder kept = with_altitudes(readings, "outliers: keep\n");
  EXPECT_EQ(kept.info(1).altitude_m, 50.0);
  EXPECT_EQ(kept.info(1).altitude_sigma_m, 0.0);
  EXPECT_THAT(kept.remarks(),
              ElementsAre("altimeter0: 1 of 11 readings contradict their neighbours (first: line "
                          "7, 50 m where its neighbours have 2 m); 'outliers: keep' in its "
                          "sensor.yaml keeps them"));
}

TEST(AltimeterOutliers, SigmaGrowsWithTheGapAndWithWhatNeighboursDifferBy) {
  std::vector<std::string> one = eleven("2");
  one[5] = "4.5";
  std::vector<std::string> three = one;
  three[4] = "50";
  three[6] = "0.9";
  std::vector<std::string> rough = one;
  rough[3] = rough[6] = "2.2";
  const std::string stated = "sigma_absolute: 0.03\n";
  const double sigma_m = with_altitudes(one, stated).info(1).altitude_sigma_m;
  EXPECT_NEAR(sigma_m, std::hypot(0.03, 0.02 * std::sqrt(3.0)), 1e-12);
  EXPECT_NEAR(with_altitudes(three, stated).info(1).altitude_sigma_m,
              std::hypot(0.03, 0.02 * std::sqrt(5.0)), 1e-12);
  // The two on either side are 2.2 and 2 m twice: √(4 · 0.1² / 3).
  EXPECT_NEAR(with_altitudes(rough, stated).info(1).altitude_sigma_m,
              std::hypot(0.03, std::sqrt(0.04 / 3.0) * std::sqrt(3.0)), 1e-12);
  EXPECT_NEAR(with_altitudes(rough).info(1).altitude_m, 2.1, 1e-12);
}

TEST(AltimeterOutliers, AtAnEndTheNearestReadingHolds) {
  std::vector<std::string> readings = eleven("2");
  readings[10] = "9";
  const ImageFolder folder = with_altitudes(readings);
  EXPECT_EQ(folder.info(2).altitude_m, 2.0);
  EXPECT_NEAR(folder.info(2).altitude_sigma_m, 0.02 * std::sqrt(3.0), 1e-12);
}

TEST(AltimeterOutliers, WithoutAnEchoThereIsNoAltitude) {
  std::vector<std::string> readings = eleven("2");
  readings[1] = "0";
  readings[5] = "-1";
  const ImageFolder folder = with_altitudes(readings);
  EXPECT_NEAR(folder.info(1).altitude_m, 2.0, 1e-12);
  EXPECT_THAT(folder.remarks(), ElementsAre(HasSubstr("2 of 11 readings left out (first: line 3, "
                                                      "0 m where its neighbours have 2 m)")));
  const std::string refusal = "data.csv:3: altitude 0 is not above the floor";
  EXPECT_THAT(input_error_of([&] { with_altitudes(readings, "outliers: keep\n"); }),
              HasSubstr(refusal));
  for (const std::size_t i : {2, 3, 4, 6}) readings[i] = "0";
  EXPECT_THAT(input_error_of([&] { with_altitudes(readings); }), HasSubstr(refusal));
}

TEST(AltimeterOutliers, ReliefAndStepsStay) {
  EXPECT_THAT(with_altitudes({"2", "2.4", "2", "1.7", "2.2", "1.9", "2.4", "1.8", "2", "2.3", "2"})
                  .remarks(),
              IsEmpty());
  const ImageFolder step = with_altitudes({"2", "2", "2", "2", "2", "5", "5", "5", "5", "5", "5"});
  EXPECT_EQ(step.info(1).altitude_m, 5.0);
  EXPECT_THAT(step.remarks(), IsEmpty());
}

// Readings 1.5 s apart: without the outliers the gap is 6 s.
TEST(AltimeterOutliers, FramesInTheGapAreServed) {
  FolderFixture fixture;
  fixture.files["cam0/data.csv"] = "0,a.png\n4500000000,b.png\n10500000000,c.png\n";
  std::string altitudes;
  for (int i = 0; i < 8; ++i) {
    altitudes += std::to_string(1'500'000'000LL * i) + "," + (i > 1 && i < 5 ? "30" : "2") + "\n";
  }
  fixture.files["altimeter0/data.csv"] = altitudes;
  fixture.files.erase("odometry0/data.csv");
  fixture.files.erase("state_groundtruth_estimate0/data.csv");
  const ImageFolder folder(fixture.write());
  EXPECT_NEAR(folder.info(1).altitude_m, 2.0, 1e-12);
  EXPECT_NEAR(folder.info(1).altitude_sigma_m, 0.02 * std::sqrt(5.0), 1e-12);
}

TEST(AttitudeOutliers, ARollThatJumpsOutAndBackIsLeftOut) {
  FolderFixture fixture;
  std::vector<std::string> readings = eleven("0.02,-0.01,0.005");
  readings[5] = "0.9,-0.01,0.005";
  fixture.files["attitude0/data.csv"] = rows(readings);
  const ImageFolder folder(fixture.write());
  EXPECT_NEAR(folder.info(1).tilt->tilt.roll_rad, 0.02, 1e-12);
  EXPECT_NEAR(folder.info(1).tilt->sigma_rad, 0.005 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(folder.info(0).tilt->sigma_rad, 0.005);
  EXPECT_THAT(folder.remarks(),
              ElementsAre(HasSubstr("attitude0: 1 of 11 readings left out (first: line 7, roll and "
                                    "pitch 0.9, -0.01 rad where its neighbours have 0.02, ")));
  fixture.files["attitude0/sensor.yaml"] = "outliers: keep\n";
  const ImageFolder kept(fixture.write());
  EXPECT_EQ(kept.info(1).tilt->tilt.roll_rad, 0.9);
  EXPECT_THAT(kept.remarks(), ElementsAre(HasSubstr("attitude0: 1 of 11 readings contradict")));
}

// Odometry turns by a right angle from picture to picture and so does the compass; north of it is
// anywhere.
TEST(CompassOutliers, AreThoseThatDeadReckoningContradictsToo) {
  FolderFixture fixture;
  fixture.files["odometry0/data.csv"] =
      "0,0,0,0,1,1,1\n1000,1,0,1.5708,0.01,0.01,0.01\n2000,1,1,3.1416,0.01,0.01,0.01\n";
  std::vector<std::string> readings;
  for (int i = 0; i <= 10; ++i) readings.push_back(std::to_string(-1.0 + 0.31416 * i) + ",0.02");
  readings[3] = "2.9,0.02";
  fixture.files["compass0/data.csv"] = rows(readings);
  const ImageFolder folder(fixture.write());
  ASSERT_EQ(folder.sensors().compass->readings.size(), 10U);
  EXPECT_EQ(folder.sensors().compass->readings[3].time_ns, 800);
  EXPECT_THAT(
      folder.remarks(),
      ElementsAre(HasSubstr("compass0: 1 of 11 readings left out (first: line 5, 3.01 rad")));
  fixture.files["compass0/sensor.yaml"] = "outliers: keep\n";
  const ImageFolder kept(fixture.write());
  EXPECT_EQ(kept.sensors().compass->readings.size(), 11U);
  EXPECT_THAT(kept.remarks(), ElementsAre(HasSubstr("compass0: 1 of 11 readings contradict")));
}

// A hundred metres from picture to picture: a fix that stays behind is as wrong as one far off.
TEST(FixOutliers, AreThoseThatMoveOtherwiseThanDeadReckoning) {
  FolderFixture fixture;
  fixture.files["odometry0/data.csv"] = "0,0,0,0,1,1,1\n1000,100,0,0,1,1,1\n2000,200,0,0,1,1,1\n";
  std::vector<std::string> readings;
  for (int i = 0; i <= 10; ++i) readings.push_back("7," + std::to_string(20 * i) + ",1,0,1");
  readings[4] = "7,20,1,0,1";
  const std::string header = "#t,x,y,var_x,cov_xy,var_y\n";
  fixture.files["position0/data.csv"] = header + rows(readings);
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.sensors().fixes->in_world.size(), 10U);
  EXPECT_THAT(folder.remarks(),
              ElementsAre(HasSubstr("position0: 1 of 11 readings left out (first: line 7, 40 m")));
  fixture.files["position0/sensor.yaml"] = "outliers: keep\n";
  const ImageFolder kept(fixture.write());
  EXPECT_EQ(kept.sensors().fixes->in_world.size(), 11U);
  EXPECT_THAT(kept.remarks(), ElementsAre(HasSubstr("position0: 1 of 11 readings contradict")));
}

// A degree of latitude is 111.2 km; these are 1.1 m apart, and one is 111 m away.
TEST(FixOutliers, OnEarth) {
  FolderFixture fixture;
  fixture.files.erase("odometry0/data.csv");
  std::vector<std::string> readings;
  for (int i = 0; i <= 10; ++i) {
    readings.push_back(std::to_string(45.0 + 0.00001 * i) + ",3,1,0,1");
  }
  readings[8] = "45.001,3,1,0,1";
  fixture.files["position0/data.csv"] =
      "#t,latitude,longitude,var_north,cov_north_east,var_east\n" + rows(readings);
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.sensors().fixes->on_earth.size(), 10U);
  EXPECT_THAT(folder.remarks(), ElementsAre(HasSubstr("(first: line 11, 103 m from the fix")));
}

}  // namespace
}  // namespace fathom
