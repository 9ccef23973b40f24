// Surveys with one thing wrong, as users report them: each is survived, or its cause is the first
// thing said, with its number and the line to write.

#include "apps/faults.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
TEST_F(Faults, WithoutOneNothingIsSaid) {
  expect_right();
}

TEST_F(Faults, AltitudesEighteenPercentTooLarge) {
  map("altimeter0", 1, [](double h, auto, auto) { return 1.18 * h; });
  EXPECT_THAT(first_said(), AllOf(ContainsRegex("registered motions are 1\\.1[678]. ± 0\\.0"),
                                  ContainsRegex("'scale: 0\\.8[45].*altimeter0")));
  write("data/mav0/altimeter0/sensor.yaml", "scale: 0.8475\n");
  expect_right();
}

TEST_F(Faults, AFocalLengthFifteenPercentTooShort) {
  set_camera("intrinsics", "[110.5, 110.5, 79.5, 59.5]");
  EXPECT_THAT(first_said(), ContainsRegex("focal length 0\\.8[456]"));
}

TEST_F(Faults, PicturesOfHalfTheSizeOfTheCalibration) {
  redraw([](const cv::Mat& picture) {
    cv::Mat half;
    cv::resize(picture, half, {80, 60}, 0.0, 0.0, cv::INTER_AREA);
    return half;
  });
  set_camera("resolution", "[80, 60]");
  EXPECT_THAT(first_said(), AllOf(HasSubstr("pictures' size is not the calibration's"),
                                  HasSubstr("2.00 times as large")));
}

TEST_F(Faults, ACameraTurnedByAQuarter) {
  redraw([](const cv::Mat& picture) {
    cv::Mat turned;
    cv::rotate(picture, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
    return turned;
  });
  set_camera("resolution", "[120, 160]");
  set_camera("intrinsics", "[130, 130, 59.5, 79.5]");
  EXPECT_THAT(first_said(), AllOf(HasSubstr("the camera is turned"), HasSubstr("yaw: -1.571}'")));
  set_camera("mounting", "{x: 0.000, y: 0.000, yaw: -1.571}");
  expect_right();
}

TEST_F(Faults, MirroredPictures) {
  redraw([](const cv::Mat& picture) {
    cv::Mat mirrored;
    cv::flip(picture, mirrored, 1);
    return mirrored;
  });
  EXPECT_THAT(first_said(), AllOf(HasSubstr("the pictures are mirrored"),
                                  HasSubstr("'mirrored: true' in cam0/sensor.yaml")));
  write("data/mav0/cam0/sensor.yaml", bytes_of("data/mav0/cam0/sensor.yaml") + "mirrored: true\n");
  expect_right();
}

TEST_F(Faults, OdometryThatIsASecondLate) {
  change("odometry0", [](Rows& rows) {
    for (auto& row : rows) row[0] = std::to_string(std::stoll(row[0]) + 1'000'000'000);
    rows.insert(rows.begin(), rows[0]);  // it stands still until its first reading
    rows[0][0] = "0";
    std::copy(rows[2].begin() + 4, rows[2].end(), rows[1].begin() + 4);
  });
  EXPECT_THAT(first_said(),
              AllOf(ContainsRegex("odometry0's time stamps are (0\\.9[89].|1\\.0[012].) ± "),
                    ContainsRegex("'time_offset_s: -(0\\.9[89]|1\\.0)")));
  write("data/mav0/odometry0/sensor.yaml", "time_offset_s: -1\n");
  expect_right();
}

TEST_F(Faults, OdometryThatIsNorthEastDown) {
  map("odometry0", 2, [](double y, auto, auto) { return -y; });
  map("odometry0", 3, [](double heading, auto, auto) { return -heading; });
  EXPECT_THAT(first_said(), AllOf(HasSubstr("y to starboard and heading clockwise"),
                                  HasSubstr("'convention: north_east_down'")));
  write("data/mav0/odometry0/sensor.yaml", "convention: north_east_down\n");
  expect_right();
}

TEST_F(Faults, OdometryWhoseHeadingsAreDegrees) {
  map("odometry0", 3,
      [](double heading, auto, auto) { return heading * 180.0 / std::numbers::pi; });
  EXPECT_THAT(first_said(), HasSubstr("'heading_unit: degrees' in odometry0/sensor.yaml"));
  write("data/mav0/odometry0/sensor.yaml", "heading_unit: degrees\n");
  expect_right();
}

TEST_F(Faults, OdometryThatStartsAgain) {
  for (const std::size_t column : {1, 2}) {
    double start_m = 0.0;
    map("odometry0", column, [&start_m](double position_m, std::size_t i, std::size_t n) {
      if (i == n / 2) start_m = position_m;
      return position_m - start_m;
    });
  }
  EXPECT_THAT(survived(), HasSubstr("odometry0 starts again at line "));
}

TEST_F(Faults, PicturesInReverseOrder) {
  change("cam0", [](Rows& rows) {
    for (std::size_t i = 0; i < rows.size() / 2; ++i) {
      std::swap(rows[i][1], rows[rows.size() - 1 - i][1]);
    }
  });
  EXPECT_THAT(first_said(), HasSubstr("the pictures are in reverse order"));
}

TEST_F(Faults, PicturesAfterACounterThatRolledOver) {
  change("cam0", [](Rows& rows) {
    Rows shown = rows;
    std::rotate(shown.begin(), shown.begin() + std::ssize(shown) / 3, shown.end());
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i][1] = shown[i][1];
  });
  EXPECT_THAT(first_said(), AllOf(HasSubstr("pictures are not in the order"),
                                  HasSubstr("a counter that rolled over")));
}

TEST_F(Faults, PicturesThatAreExchanged) {
  change("cam0", [](Rows& rows) {
    for (std::size_t i = 4; i + 1 < rows.size(); i += 10) std::swap(rows[i][1], rows[i + 1][1]);
  });
  EXPECT_THAT(first_said(), HasSubstr("picture 5 belongs 1 place later, picture 6 belongs 1 place "
                                      "earlier"));
}

TEST_F(Faults, AnAltimeterWithSpikes) {
  map("altimeter0", 1, [](double h, std::size_t i, auto) {
    return i % 10 == 4 ? h * (i % 20 == 4 ? 0.5 : 25.0) : h;
  });
  EXPECT_THAT(survived(), ContainsRegex("altimeter0: [0-9]+ of [0-9]+ readings left out"));
}

TEST_F(Faults, AnAltimeterThatSteps) {
  map("altimeter0", 1,
      [](double h, std::size_t i, std::size_t n) { return i < n / 2 ? h : 1.3 * h; });
  EXPECT_THAT(first_said(), AllOf(ContainsRegex("grow by a factor 1\\.(2[6-9]|3[0-4])"),
                                  HasSubstr("altimeter0 steps there")));
}

TEST_F(Faults, ACompassThatCountsClockwise) {
  std::string rows = "#timestamp [ns],heading [rad],sigma [rad]\n";
  change("state_groundtruth_estimate0", [&rows](Rows& truth) {
    for (const auto& row : truth) {
      const double heading_rad = 2.0 * std::atan2(std::stod(row[7]), std::stod(row[4]));
      const double circle_rad = 2.0 * std::numbers::pi;
      rows +=
          row[0] + "," + exact(std::fmod(2.0 * circle_rad - heading_rad, circle_rad)) + ",0.02\n";
    }
  });
  fs::create_directory(path("data/mav0/compass0"));
  write("data/mav0/compass0/data.csv", rows);
  EXPECT_THAT(first_said(), AllOf(HasSubstr("compass0 counts the other way"),
                                  HasSubstr("'convention: clockwise_from_north'")));
}

TEST_F(Faults, HiddenFilesBesideThePictures) {
  write("data/mav0/cam0/data/._0.png", "x");
  EXPECT_THAT(survived(), HasSubstr("1 hidden file left out, such as ._0.png"));
}

TEST_F(Faults, AMisspeltFolderAndACameraUnlikeOthers) {
  fs::create_directory(path("data/mav0/attitude"));
  set_camera("intrinsics", "[130, 150, 59.5, 79.5]");
  for (const Arguments& command :
       {Arguments{"check", "data"}, Arguments{"run", "data", "--out", "run", "--no-mosaic"}}) {
    EXPECT_THAT(
        fathom_done(command).out,
        AllOf(HasSubstr("mav0/attitude is not read; did you mean 'attitude0'?"),
              HasSubstr("cam0/sensor.yaml: fx 130 and fy 150 differ by 14 %; pixels are square"),
              HasSubstr("cam0/sensor.yaml: cx 59.5 and cy 79.5 look exchanged")));
  }
}

TEST_F(Faults, TheVehicleInEveryPicture) {
  cv::RNG random(3);
  cv::Mat skid(16, 160, CV_8U);
  random.fill(skid, cv::RNG::UNIFORM, 30, 220);
  cv::resize(skid(cv::Rect(0, 0, 80, 8)).clone(), skid, skid.size(), 0, 0, cv::INTER_NEAREST);
  redraw([&skid](const cv::Mat& picture) {
    cv::Mat with = picture.clone();
    skid.copyTo(with.rowRange(104, 120));
    return with;
  });
  EXPECT_THAT(survived(), AllOf(HasSubstr("masked: "), HasSubstr("the lowest ")));
  EXPECT_TRUE(fs::exists(path("run/mask.png")));
}

}  // namespace
}  // namespace fathom::test
