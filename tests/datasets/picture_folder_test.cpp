#include "fathom/datasets/picture_folder.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "fathom/datasets/picture_file.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"
#include "support/requirements.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Pictures : public ::testing::Test {
 protected:
  Pictures() {
    options.path = root.path().string();
    options.altitude_m = 2.0;
    options.focal_px = 10.0;
  }

  void add(const std::string& name, int grey = 90, cv::Size size = {8, 6}) const {
    test::write_picture(root / name, cv::Mat(size, CV_8UC1, cv::Scalar(grey)));
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(root / name, std::ios::binary) << text;
  }

  std::string error() const {
    return input_error_of([this] { PictureFolder folder(options); });
  }

  test::TemporaryFolder root;
  PictureFolderOptions options;
};

TEST_F(Pictures, StandInTheOrderOfTheirNumbers) {
  add("shot10.png", 10);
  add("shot9.PNG", 9);
  add("shot010b.png", 11);
  add("shot100.pgm", 100);
  write("notes.txt", "not a picture");
  const PictureFolder folder(options);
  ASSERT_EQ(folder.size(), 4u);
  EXPECT_EQ(folder.image(0).at<uchar>(0, 0), 9);
  EXPECT_EQ(folder.image(1).at<uchar>(0, 0), 10);
  EXPECT_EQ(folder.image(2).at<uchar>(0, 0), 11);
  EXPECT_EQ(folder.image(3).at<uchar>(0, 0), 100);
  EXPECT_EQ(folder.info(3).time_ns, 3'000'000'000);
  EXPECT_EQ(folder.info(3).altitude_m, 2.0);
  EXPECT_FALSE(folder.has_odometry());
  EXPECT_NE(folder.picture_id(0), folder.picture_id(1));
  EXPECT_EQ(folder.files().size(), 4u);
}

TEST(PictureNames, AreOrderedStrictly) {
  const std::vector<std::string> rising{"", "1", "01", "2", "10", "a", "a1", "a1b", "a02", "a10"};
  for (std::size_t i = 0; i < rising.size(); ++i) {
    for (std::size_t j = 0; j < rising.size(); ++j) {
      // "01" and "1" are one number: which of them comes first is no matter, but one does.
      if (rising[i] == "01" || rising[j] == "01") continue;
      EXPECT_EQ(is_before(rising[i], rising[j]), i < j) << rising[i] << " " << rising[j];
    }
  }
  EXPECT_NE(is_before("1", "01"), is_before("01", "1"));
  EXPECT_TRUE(is_before("99999999999999999999998", "99999999999999999999999"));
}

TEST_F(Pictures, FocalLengthOrFieldOfViewMakeTheCamera) {
  add("a.png");
  EXPECT_EQ(PictureFolder(options).camera().model().fx, 10.0);
  EXPECT_EQ(PictureFolder(options).camera().model().cx, 3.5);
  options.focal_px.reset();
  EXPECT_THAT(error(), AllOf(HasSubstr("dataset.camera.focal_px"), HasSubstr("sensor width"),
                             HasSubstr("field_of_view_rad")));
  options.field_of_view_rad = M_PI / 2;
  EXPECT_NEAR(PictureFolder(options).camera().model().fx, 4.0, 1e-12);
  options.focal_px = 10.0;
  EXPECT_THAT(error(), HasSubstr("field_of_view_rad"));
}

TEST_F(Pictures, AltitudesAndOdometryAreByName) {
  for (const char* name : {"a.png", "b.png", "c.png"}) add(name);
  options.altitude_m.reset();
  EXPECT_THAT(error(), HasSubstr("dataset.altitude_m"));
  options.altitudes = (root / "altitudes.csv").string();
  write("altitudes.csv", "# filename, metres\na.png, 1.5\nb.png,2\r\nc.png,2.5\n");
  options.odometry = (root / "odometry.csv").string();
  write("odometry.csv",
        "a.png,5,5,1.5707963267948966,0,0,0\n"
        "b.png,5,7,1.5707963267948966,0.01,0.02,0.003\n"
        "c.png,4,7,3.1,0.01,0.02,0.003,0.001,0.002,-0.001\n");
  const PictureFolder folder(options);
  EXPECT_EQ(folder.info(2).altitude_m, 2.5);
  ASSERT_TRUE(folder.has_odometry());
  EXPECT_FALSE(folder.info(0).motion);
  EXPECT_NEAR(folder.info(1).motion->mean.x, 2.0, 1e-12);
  EXPECT_NEAR(folder.info(1).motion->mean.y, 0.0, 1e-12);
  EXPECT_NEAR(folder.info(2).motion->mean.y, 1.0, 1e-12);
  EXPECT_EQ(folder.info(2).motion->covariance(0, 2), 0.002);
  EXPECT_EQ(folder.files().size(), 5u);
}

// Headings of another unit or sense are found in what was written, not in what it was read as.
TEST_F(Pictures, OdometryIsKnownAsItIsWritten) {
  for (const char* name : {"a.png", "b.png"}) add(name);
  EXPECT_TRUE(PictureFolder(options).recorded_odometry().rows.empty());
  options.odometry = (root / "odometry.csv").string();
  write("odometry.csv", "a.png,5,5,350,0,0,0\nb.png,5,7,260,0.01,0.02,0.003\n");
  const PictureFolder folder(options);
  const std::vector<ReckonedRow> rows = folder.recorded_odometry().rows;
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].heading_rad, 350.0);
  EXPECT_EQ(rows[1].heading_rad, 260.0);
  EXPECT_EQ(rows[1].y_m, 7.0);
  EXPECT_EQ(rows[1].time_ns, folder.info(1).time_ns);
}

TEST_F(Pictures, TablesThatDoNotFitAreRefusedByTheirLine) {
  for (const char* name : {"a.png", "b.png"}) add(name);
  options.altitude_m.reset();
  options.altitudes = (root / "t.csv").string();
  const auto refused = [&](const std::string& text) {
    write("t.csv", text);
    return error();
  };
  EXPECT_THAT(refused("a.png,2\n"), AllOf(HasSubstr("t.csv"), HasSubstr("no row for b.png")));
  EXPECT_THAT(refused("b.png,2\na.png,2\n"), AllOf(HasSubstr("t.csv:1"), HasSubstr("'a.png'")));
  EXPECT_THAT(refused("a.png,2\nb.png,2\nc.png,2\n"), HasSubstr("t.csv:3: there are only 2"));
  EXPECT_THAT(refused("a.png,2\nb.png,-2\n"), HasSubstr("t.csv:2: the altitude is not above"));
  EXPECT_THAT(refused("a.png,2\nb.png,nan\n"),
              HasSubstr("t.csv:2: 'nan' in column 2 of filename, altitude is not a finite"));
  EXPECT_THAT(refused("a.png,2\nb.png\n"), HasSubstr("t.csv:2: expected 2 columns filename"));
}

TEST_F(Pictures, HiddenFilesAreLeftOutAndCounted) {
  for (const char* name : {"a.png", "b.png"}) add(name);
  EXPECT_TRUE(PictureFolder(options).remarks().empty());
  write("._b.png", std::string("\0\5\26\7", 4));
  write("._a.png", std::string("\0\5\26\7", 4));
  const PictureFolder folder(options);
  EXPECT_EQ(folder.size(), 2u);
  EXPECT_THAT(folder.remarks(),
              ElementsAre(AllOf(HasSubstr(": 2 hidden files left out, such as ._a.png"))));
  const test::TemporaryFolder hidden_alone;
  std::ofstream(hidden_alone / ".a.png") << "x";
  EXPECT_FALSE(is_plain_picture_folder(hidden_alone.path()));
}

// A JPEG with DateTimeOriginal, as a camera writes it: APP1 with one entry, which points to the
// Exif directory with one entry.
std::string jpeg_at(const std::string& time) {
  const std::string jpeg = encode_picture(".jpg", cv::Mat(6, 8, CV_8UC1, cv::Scalar(90)));
  using namespace std::string_literals;
  const std::string tiff = "II*\0\x08\0\0\0"s +
                           "\x01\0\x69\x87\x04\0\x01\0\0\0\x1A\0\0\0\0\0\0\0"s +
                           "\x01\0\x03\x90\x02\0\x14\0\0\0\x2C\0\0\0\0\0\0\0"s + time + "\0"s;
  const std::string body = "Exif\0\0"s + tiff;
  const auto length = static_cast<char>(body.size() + 2);
  return jpeg.substr(0, 2) + "\xFF\xE1\0"s + length + body + jpeg.substr(2);
}

TEST_F(Pictures, HaveTheTimesOfTheirExifIfTheseRise) {
  FATHOM_REQUIRE_FEATURE("exif");
  write("a.jpg", jpeg_at("2024:05:17 10:31:02"));
  write("b.jpg", jpeg_at("2024:05:17 10:31:05"));
  write("c.jpg", jpeg_at("2024:05:17 10:32:05"));
  const PictureFolder folder(options);
  EXPECT_EQ(folder.info(1).time_ns - folder.info(0).time_ns, 3'000'000'000);
  EXPECT_EQ(folder.info(2).time_ns - folder.info(1).time_ns, 60'000'000'000);
  EXPECT_TRUE(folder.remarks().empty());
  EXPECT_TRUE(folder.has_own_times());
  write("c.jpg", jpeg_at("2024:05:17 10:31:04"));
  const PictureFolder rolled(options);
  EXPECT_EQ(rolled.info(2).time_ns, 2'000'000'000);
  EXPECT_FALSE(rolled.has_own_times());
  EXPECT_THAT(rolled.remarks(), ElementsAre(HasSubstr("c.jpg: by its EXIF before the picture")));
}

TEST_F(Pictures, OfAnotherSizeAreRefusedByName) {
  add("a.png");
  add("b.png", 90, {6, 8});
  const PictureFolder folder(options);
  EXPECT_THAT(input_error_of([&] { folder.image(1); }),
              AllOf(HasSubstr("b.png"), HasSubstr("6 x 8"), HasSubstr("8 x 6")));
}

TEST_F(Pictures, AFolderWithoutAnyIsRefused) {
  EXPECT_THAT(error(), HasSubstr("holds no pictures"));
  options.path = (root / "nowhere").string();
  EXPECT_THAT(error(), HasSubstr("is no folder"));
}

// A ramp of 12 bits in 16, one pixel of it saturated: 4095 becomes white, half of it grey.
TEST_F(Pictures, OfSixteenBitUseTheBitsThatTheyHave) {
  cv::Mat ramp(64, 64, CV_16UC1);
  for (int i = 0; i < 4096; ++i) ramp.at<ushort>(i / 64, i % 64) = static_cast<ushort>(i);
  ramp.at<ushort>(0, 0) = 65535;
  test::write_picture(root / "ramp.png", ramp);
  const cv::Mat grey = read_grey_picture(root / "ramp.png");
  ASSERT_EQ(grey.type(), CV_8U);
  EXPECT_EQ(grey.at<uchar>(0, 0), 255);
  EXPECT_EQ(grey.at<uchar>(63, 63), 255);
  EXPECT_NEAR(grey.at<uchar>(32, 0), 128, 1);
  EXPECT_NEAR(grey.at<uchar>(0, 32), 2, 1);
  cv::Mat colour;
  cv::merge(std::vector<cv::Mat>{ramp, ramp, ramp}, colour);
  test::write_picture(root / "colour.tif", colour);
  EXPECT_LE(cv::norm(read_grey_picture(root / "colour.tif"), grey, cv::NORM_INF), 1.0);
}

// The upper eight of 8, 9, 10, … bits in 16, of each number.
TEST_F(Pictures, OfSixteenBitLoseOnlyTheirLowestBits) {
  for (int bits = 8; bits <= 16; ++bits) {
    const int side = 1 << (bits / 2);
    cv::Mat ramp((1 << bits) / side, side, CV_16UC1);
    for (int i = 0; i < 1 << bits; ++i) {
      ramp.at<ushort>(i / side, i % side) = static_cast<ushort>(i);
    }
    test::write_picture(root / "ramp.png", ramp);
    const cv::Mat grey = read_grey_picture(root / "ramp.png");
    int others = 0;
    for (int i = 0; i < 1 << bits; ++i) {
      others += grey.at<uchar>(i / side, i % side) == i >> (bits - 8) ? 0 : 1;
    }
    EXPECT_EQ(others, 0) << bits;
  }
}

}  // namespace
}  // namespace fathom
