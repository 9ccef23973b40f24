#include "fathom/vision/picture_codecs.hpp"

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(PictureCodecs, DecodeWhatTheyEncoded) {
  cv::Mat picture(7, 5, CV_16U);
  cv::randu(picture, 0, 65536);
  for (const char* ending : {".png", ".tif", ".pgm"}) {
    const cv::Mat decoded = decode_picture(encode_picture(ending, picture));
    ASSERT_EQ(decoded.size(), picture.size()) << ending;
    ASSERT_EQ(decoded.type(), picture.type()) << ending;
    EXPECT_EQ(cv::norm(decoded, picture, cv::NORM_INF), 0.0) << ending;
  }
}

// Red, green and blue of a file written by hand, in OpenCV's order.
TEST(PictureCodecs, KeepTheOrderOfColours) {
  const cv::Mat pixel = decode_picture("P6\n1 1\n255\n\x01\x02\x03");
  ASSERT_EQ(pixel.type(), CV_8UC3);
  EXPECT_EQ(pixel.at<cv::Vec3b>(0, 0), cv::Vec3b(3, 2, 1));
  EXPECT_EQ(encode_picture(".ppm", pixel).substr(11), "\x01\x02\x03");
}

TEST(PictureCodecs, GiveNothingOfWhatIsNoPicture) {
  EXPECT_TRUE(decode_picture("").empty());
  EXPECT_TRUE(decode_picture("no picture").empty());
}

TEST(PictureCodecs, GiveNothingWhereAFormatDoesNotHoldThePicture) {
  const cv::Mat picture(7, 5, CV_8U, cv::Scalar(1));
  EXPECT_TRUE(encode_picture(".none", picture).empty());
  EXPECT_TRUE(encode_picture("", picture).empty());
  EXPECT_TRUE(encode_picture(".png", {}).empty());
}

}  // namespace
}  // namespace fathom
