// Image folders and pictures that would fill memory, or have other files read.

#include "fathom/core/limits.hpp"

#include <boost/crc.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/asl_files.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

using test::FolderFixture;
using test::input_error_of;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::string refusal_of_picture(const std::string& bytes) {
  testing::internal::CaptureStderr();
  std::string message = input_error_of([&] { decode_grey_picture(bytes, "p"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  return message;
}

// As written by an encoder, but for the numbers of its header.
std::string with_bytes(std::string bytes, std::size_t at, const std::string& other) {
  return bytes.replace(at, other.size(), other);
}

TEST(PictureLimits, AHeaderThatAsksForAllMemoryIsRefusedBeforeDecoding) {
  const cv::Mat small(6, 8, CV_8UC1, cv::Scalar(90));
  const std::string large =
      "p: has 60000 x 60000 pixels in all; " + limit_text(Limit::picture_pixels);
  const std::string big = {'\0', '\0', '\xEA', '\x60'};
  const std::string little = {'\x60', '\xEA', '\0', '\0'};
  EXPECT_EQ(refusal_of_picture(with_bytes(encode_picture(".png", small), 16, big + big)), large);
  EXPECT_EQ(refusal_of_picture(with_bytes(encode_picture(".bmp", small), 18, little + little)),
            large);
  EXPECT_EQ(refusal_of_picture("P5\n# 1 2\n60000 60000\n255\n"), large);
  const std::string jpeg = encode_picture(".jpg", small);
  const std::size_t frame = jpeg.find("\xFF\xC0");
  ASSERT_NE(frame, std::string::npos);
  EXPECT_EQ(refusal_of_picture(with_bytes(jpeg, frame + 5, big.substr(2) + big.substr(2))), large);
  std::string tiff = encode_picture(".tiff", small);
  ASSERT_EQ(tiff.substr(0, 4), std::string("II*\0", 4));
  const auto directory =
      static_cast<unsigned char>(tiff[4]) + 256U * static_cast<unsigned char>(tiff[5]);
  for (std::size_t i = 0; i < 10; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    const bool is_side = tiff[entry + 1] == 1 && (tiff[entry] == 0 || tiff[entry] == 1);
    if (is_side) tiff.replace(entry + 8, 2, little.substr(0, 2));
  }
  EXPECT_EQ(refusal_of_picture(tiff), large);
  EXPECT_EQ(
      refusal_of_picture(with_bytes(encode_picture(".png", small), 16, std::string(8, '\xFF'))),
      "p: has 4294967295 x 4294967295 pixels in all; " + limit_text(Limit::picture_pixels));
}

TEST(PictureLimits, PicturesOfAllFormatsAreRead) {
  cv::Mat picture(6, 8, CV_8UC1);
  for (int i = 0; i < 48; ++i) picture.at<uchar>(i / 8, i % 8) = static_cast<uchar>(5 * i);
  for (const char* const extension : {".png", ".bmp", ".tiff", ".pgm", ".jpg", ".webp"}) {
    EXPECT_EQ(decode_grey_picture(encode_picture(extension, picture), "p").size(), picture.size())
        << extension;
  }
}

// Nothing is printed but our line: libpng would say more.
TEST(PictureLimits, ADamagedPngIsOneLine) {
  cv::Mat picture(60, 80, CV_8UC1);
  cv::randu(picture, 0, 255);
  const std::string png = encode_picture(".png", picture);
  for (const std::size_t at : {std::size_t{23}, std::size_t{45}, png.size() / 2, png.size() - 20}) {
    std::string damaged = png;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_THAT(refusal_of_picture(damaged), HasSubstr("p: is no picture that can be read"))
        << "byte " << at;
  }
  EXPECT_THAT(refusal_of_picture(png.substr(0, png.size() / 2)), HasSubstr("is no picture"));
  EXPECT_THAT(refusal_of_picture(png.substr(0, 20)), HasSubstr("is no picture"));
}

// Its checksum agrees: only what it says is wrong.
TEST(PictureLimits, APngWithAnImpossibleHeaderIsOneLine) {
  const std::string png = encode_picture(".png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(90)));
  const auto with_header = [&](std::size_t at, const std::string& other) {
    std::string bytes = with_bytes(png, at, other);
    boost::crc_32_type sum;
    sum.process_bytes(bytes.data() + 12, 17);
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[29 + i] = static_cast<char>(sum.checksum() >> (24 - 8 * i) & 0xFFU);
    }
    return bytes;
  };
  for (const auto& [at, other] : std::vector<std::pair<std::size_t, std::string>>{
           {16, std::string(8, '\0')},          // no column, no row
           {16, std::string("\0\0\0\0", 4)},    // no column
           {16, std::string("\0\x20\0\0", 4)},  // more columns than libpng has
           {24, "\x03"},                        // bits of a sample
           {25, "\x01"},                        // colour type
           {26, "\x01"},                        // compression
           {27, "\x01"},                        // filter
           {28, "\x02"}}) {                     // interlace
    EXPECT_THAT(refusal_of_picture(with_header(at, other)), HasSubstr("is no picture that can be"))
        << at;
  }
}

// A text in the file is no part of the picture.
TEST(PictureLimits, ADamagedNoteInAPngIsLeftOut) {
  const cv::Mat picture(6, 8, CV_8UC1, cv::Scalar(90));
  std::string png = encode_picture(".png", picture);
  png.insert(33, std::string("\0\0\0\5tEXta\0bcd????", 17));
  testing::internal::CaptureStderr();
  const cv::Mat read = decode_grey_picture(png + "behind its end", "p");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(read.at<uchar>(0, 0), 90);
}

// By its header, which is all that is whole of it.
TEST(FolderLimits, APictureOfAnotherSizeIsNotDecoded) {
  const std::string small = encode_picture(".png", cv::Mat(6, 8, CV_8UC1, cv::Scalar(90)));
  FolderFixture fixture;
  const fs::path mask = fixture.write() / "mask.png";
  std::ofstream(mask) << with_bytes(small, 16, std::string("\0\0\x40\0\0\0\x40\0", 8));
  EXPECT_THAT(input_error_of([&] {
                read_grey_picture(mask, {8, 6}, "expected 8 x 6");
              }),
              EndsWith("mask.png: has 16384 x 16384 pixels, expected 8 x 6"));
  EXPECT_THAT(input_error_of([&] {
                read_mask(mask, {8, 6});
              }),
              HasSubstr("has 16384 x 16384 pixels, the pictures 8 x 6; expected a mask of"));
}

std::string refusal_of_folder(const std::string& file, const std::string& content) {
  FolderFixture fixture;
  fixture.files[file] = content;
  const fs::path root = fixture.write();
  return input_error_of([&] { const ImageFolder folder(root); });
}

TEST(FolderLimits, APictureIsInItsFolder) {
  for (const std::string name :
       {"/etc/hostname", "../sensor.yaml", "x/../../data.csv", "..", "."}) {
    const std::string message = refusal_of_folder("cam0/data.csv", "0,a.png\n1000," + name + "\n");
    if (name == ".") {
      EXPECT_THAT(message, HasSubstr("data.csv:2: picture ")) << name;
    } else {
      EXPECT_THAT(message, EndsWith("data.csv:2: picture '" + name +
                                    "' is outside of cam0/data; expected a name in that folder"));
    }
  }
}

TEST(FolderLimits, LinksAndFoldersInTheFolderAreFollowed) {
  FolderFixture fixture;
  fixture.files["cam0/data.csv"] = "0,a.png\n1000,sub/../sub/b.png\n2000,linked.png\n";
  const fs::path root = fixture.write();
  const fs::path data = fixture.mav0() / "cam0" / "data";
  fs::create_directory(data / "sub");
  fs::rename(data / "b.png", data / "sub" / "b.png");
  fs::rename(data / "c.png", fixture.root / "elsewhere.png");
  fs::create_symlink(fixture.root / "elsewhere.png", data / "linked.png");
  EXPECT_EQ(ImageFolder(root).size(), 3U);
}

TEST(FolderLimits, TimeStampsAreLessApartThanTheirDifferenceCanTell) {
  const std::string most = std::to_string(kMostTimeNs);
  for (const std::string stamp : {"9223372036854775807", "-9223372036854775808",
                                  "4500000000000000001", "-4500000000000000001"}) {
    const bool is_negative = stamp.front() == '-';
    const std::string rows =
        is_negative ? stamp + ",a.png\n0,b.png\n" : "0,a.png\n" + stamp + ",b.png\n";
    EXPECT_THAT(refusal_of_folder("cam0/data.csv", rows),
                EndsWith("time stamp " + stamp + " is beyond the limit of " + most +
                         " ns, which is in 2112"));
  }
  // The two ends are within it.
  EXPECT_THAT(refusal_of_folder("cam0/data.csv", "-" + most + ",a.png\n" + most + ",b.png\n"),
              HasSubstr("no altitude at or around the picture's time -" + most));
}

TEST(FolderLimits, ARowHasColumnsThatCanBeNamed) {
  std::string row = "0";
  for (int i = 0; i < 1'000'000; ++i) row += ",1";
  EXPECT_THAT(refusal_of_folder("altimeter0/data.csv", "#" + row + "\n" + row + "\n"),
              EndsWith("data.csv:2: has 1000001 columns; the limit is 1000"));
}

TEST(FolderLimits, ASensorYamlIsCountedBeforeItIsRead) {
  std::string bomb = "a: &a [1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (char name = 'b'; name < 'k'; ++name) {
    const std::string before = std::string("*") + static_cast<char>(name - 1);
    bomb += std::string(1, name) + ": &" + name + " [" + before;
    for (int i = 0; i < 7; ++i) bomb += ", " + before;
    bomb += "]\n";
  }
  for (const std::string file : {"cam0/sensor.yaml", "altimeter0/sensor.yaml"}) {
    EXPECT_THAT(refusal_of_folder(file, bomb), MatchesRegex(".*sensor.yaml:6: has too many .*"));
    EXPECT_THAT(refusal_of_folder(file, std::string(100'000, '[')),
                HasSubstr("sensor.yaml:1: is nested too deeply"));
  }
  std::string many = "resolution: [8, 6]\nintrinsics: [1";
  for (int i = 0; i < 100'000; ++i) many += ", 1";
  EXPECT_THAT(refusal_of_folder("cam0/sensor.yaml", many + "]\n"),
              EndsWith("sensor.yaml:2: intrinsics: expected [fx, fy, cx, cy]"));
  EXPECT_THAT(
      refusal_of_folder("cam0/sensor.yaml", "resolution: [8, 6]\nintrinsics: [1e999, 1, 1, 1]\n"),
      EndsWith("sensor.yaml:2: intrinsics: expected a number"));
}

}  // namespace
}  // namespace fathom
