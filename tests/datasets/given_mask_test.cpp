// Masks that come with the pictures.

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;
using testing::AllOf;
using testing::HasSubstr;

cv::Mat left_half_hidden() {
  cv::Mat mask(6, 8, CV_8U, cv::Scalar(200));
  mask.colRange(0, 4).setTo(0);
  return mask;
}

void expect_left_half_hidden(const cv::Mat& mask) {
  ASSERT_EQ(mask.size(), cv::Size(8, 6));
  EXPECT_EQ(cv::countNonZero(mask.colRange(0, 4)), 0);
  EXPECT_EQ(cv::countNonZero(mask.colRange(4, 8) == 255), 24);
}

TEST(GivenMask, OfAnImageFolderIsReadAndAmongItsFiles) {
  const FolderFixture fixture;
  const auto folder = fixture.write();
  EXPECT_TRUE(ImageFolder(folder).given_mask().empty());
  const auto file = fixture.mav0() / "cam0" / "mask.png";
  test::write_picture(file, left_half_hidden());
  const ImageFolder read(folder);
  expect_left_half_hidden(read.given_mask());
  const auto files = read.files();
  EXPECT_NE(std::ranges::find(files, file), files.end());
  write_image_folder(read, fixture.root / "again");
  expect_left_half_hidden(ImageFolder(fixture.root / "again").given_mask());
}

TEST(GivenMask, OfAnotherSizeOrThatHidesAllIsRefusedByName) {
  const FolderFixture fixture;
  const auto folder = fixture.write();
  const std::string file = (fixture.mav0() / "cam0" / "mask.png").string();
  test::write_picture(file, cv::Mat(6, 9, CV_8U, cv::Scalar(255)));
  EXPECT_THAT(input_error_of([&] { ImageFolder read(folder); }),
              AllOf(HasSubstr("mask.png"), HasSubstr("9 x 6"), HasSubstr("8 x 6")));
  test::write_picture(file, cv::Mat::zeros(6, 8, CV_8U));
  EXPECT_THAT(input_error_of([&] { ImageFolder read(folder); }),
              AllOf(HasSubstr("mask.png"), HasSubstr("hides all")));
}

TEST(GivenMask, OfPlainPicturesIsNamedByAKey) {
  const test::TemporaryFolder root;
  std::filesystem::create_directories(root / "photos");
  for (const char* name : {"1.png", "2.png"}) {
    test::write_picture(root / "photos" / name, cv::Mat(6, 8, CV_8U, cv::Scalar(90)));
  }
  test::write_picture(root / "mask.png", left_half_hidden());
  PictureFolderOptions options;
  options.path = (root / "photos").string();
  options.altitude_m = 2.0;
  options.focal_px = 10.0;
  EXPECT_TRUE(PictureFolder(options).given_mask().empty());
  options.mask = (root / "mask.png").string();
  const PictureFolder read(options);
  EXPECT_EQ(read.size(), 2u);
  expect_left_half_hidden(read.given_mask());
  options.mask = (root / "photos" / "none.png").string();
  EXPECT_THAT(input_error_of([&] { PictureFolder(PictureFolderOptions(options)); }),
              HasSubstr("none.png"));
}

}  // namespace
}  // namespace fathom
