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
