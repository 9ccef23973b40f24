// Encodings of pictures in bags: mosaics and YUV become colour, compressed ones too.

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

using test::kBegin;

constexpr int kWidth = 8;
constexpr int kHeight = 6;

struct Mosaic {
  const char* pattern;
  int red_row;
  int red_column;
};

constexpr std::array<Mosaic, 4> kMosaics{
    {{"rggb", 0, 0}, {"bggr", 1, 1}, {"grbg", 0, 1}, {"gbrg", 1, 0}}};

// Light on the red pixels alone.
template <class Level>
cv::Mat red_light(const Mosaic& mosaic, Level level) {
  cv::Mat_<Level> picture(kHeight, kWidth, Level{0});
  for (int v = mosaic.red_row; v < kHeight; v += 2) {
    for (int u = mosaic.red_column; u < kWidth; u += 2) picture(v, u) = level;
  }
  return picture;
}

class BagPictures : public test::BagTest {
 protected:
  std::unique_ptr<test::BagWriter> writer_with_camera() const {
    std::filesystem::remove(bag());
    auto bag = writer();
    test::CameraInformation info;
    info.width = kWidth;
    info.height = kHeight;
    info.K = {10, 0, 3.5, 0, 10, 2.5, 0, 0, 1};
    bag->camera_info("/cam/camera_info", {kBegin, kBegin}, info);
    return bag;
  }
  static test::RawImage raw(const std::string& encoding, const cv::Mat& picture) {
    test::RawImage image;
    image.encoding = encoding;
    image.width = static_cast<std::uint32_t>(picture.cols);
    image.height = static_cast<std::uint32_t>(picture.rows);
    image.step = static_cast<std::uint32_t>(picture.cols * picture.elemSize());
    image.data.assign(picture.datastart, picture.dataend);
    return image;
  }
  static BagImportOptions options() {
    BagImportOptions options;
    options.altitude_m = 2.0;
    return options;
  }
  std::string path(const std::string& ending) const {
    return (out() / "mav0" / "cam0" / "data" / (std::to_string(kBegin) + ending)).string();
  }
  cv::Mat imported() const { return test::read_picture(path(".png"), cv::IMREAD_UNCHANGED); }

  cv::Mat after(const test::RawImage& image) const {
    writer_with_camera()->image("/cam/image_raw", {kBegin, kBegin}, image);
    import(options());
    return imported();
  }
  void import_compressed(const std::string& format, const std::string& ending,
                         const cv::Mat& picture) {
    const std::string bytes = encode_picture(ending, picture);
    file_.assign(bytes.begin(), bytes.end());
    std::filesystem::remove_all(out());
    writer_with_camera()->compressed_image("/cam/image_raw/compressed", {kBegin, kBegin}, format,
                                           file_);
    import(options());
  }
  std::string file() const { return {file_.begin(), file_.end()}; }

  std::vector<std::uint8_t> file_;
};
INSTANTIATE_TEST_SUITE_P(Bags, BagPictures, ::testing::Values(1, 2), test::generation);

TEST_P(BagPictures, MosaicsOfEightAndSixteenBitsBecomeColour) {
  for (const Mosaic& mosaic : kMosaics) {
    const std::string name = std::string("bayer_") + mosaic.pattern;
    const cv::Mat eight = after(raw(name + "8", red_light<uchar>(mosaic, 200)));
    ASSERT_EQ(eight.type(), CV_8UC3) << name;
    EXPECT_EQ(eight.at<cv::Vec3b>(2, 4), cv::Vec3b(0, 0, 200)) << name;
    test::RawImage image = raw(name + "16", red_light<ushort>(mosaic, 40'000));
    const cv::Mat sixteen = after(image);
    ASSERT_EQ(sixteen.type(), CV_16UC3) << name;
    EXPECT_EQ(sixteen.at<cv::Vec3w>(2, 4), cv::Vec3w(0, 0, 40'000)) << name;
    EXPECT_TRUE(ImageFolder(out()).image(0).type() == CV_8UC1);
    for (std::size_t i = 0; i < image.data.size(); i += 2) {
      std::swap(image.data[i], image.data[i + 1]);
    }
    image.is_bigendian = true;
    EXPECT_EQ(cv::norm(after(image), sixteen, cv::NORM_INF), 0.0) << name;
  }
}

// Red by BT.601: Y 81, U 90, V 240.
TEST_P(BagPictures, YuvBecomesColour) {
  const cv::Mat uyvy(kHeight, kWidth / 2, CV_8UC4, cv::Scalar(90, 81, 240, 81));
  const cv::Mat yuyv(kHeight, kWidth / 2, CV_8UC4, cv::Scalar(81, 90, 81, 240));
  const std::vector<std::pair<std::string, cv::Mat>> cases{
      {"yuv422", uyvy}, {"uyvy", uyvy}, {"yuyv", yuyv}, {"yuv422_yuy2", yuyv}};
  for (const auto& [name, bytes] : cases) {
    const cv::Mat picture = after(raw(name, bytes.reshape(2)));
    ASSERT_EQ(picture.type(), CV_8UC3) << name;
    ASSERT_EQ(picture.cols, kWidth);
    EXPECT_LE(cv::norm(picture.at<cv::Vec3b>(3, 5), cv::Vec3b(0, 0, 255), cv::NORM_INF), 2.0)
        << name;
  }
  writer_with_camera()->image("/cam/image_raw", {kBegin, kBegin},
                              raw("yuyv", cv::Mat(kHeight, 7, CV_8UC2, cv::Scalar(0, 0))));
  EXPECT_THAT(refusal(options()), HasSubstr("'yuyv' is 7 pixels wide; expected an even number"));
}

TEST_P(BagPictures, SixteenBitColoursKeepTheirPlaces) {
  const cv::Mat rgb(kHeight, kWidth, CV_16UC3, cv::Scalar(1000, 2000, 30'000));
  EXPECT_EQ(after(raw("rgb16", rgb)).at<cv::Vec3w>(1, 1), cv::Vec3w(30'000, 2000, 1000));
  EXPECT_EQ(after(raw("bgr16", rgb)).at<cv::Vec3w>(1, 1), cv::Vec3w(1000, 2000, 30'000));
}

TEST_P(BagPictures, ACompressedMosaicBecomesColour) {
  for (const Mosaic& mosaic : kMosaics) {
    const std::string name = std::string("bayer_") + mosaic.pattern;
    import_compressed(name + "8; png compressed ", ".png", red_light<uchar>(mosaic, 200));
    ASSERT_EQ(imported().type(), CV_8UC3) << name;
    EXPECT_EQ(imported().at<cv::Vec3b>(2, 4), cv::Vec3b(0, 0, 200)) << name;
  }
  import_compressed("bayer_grbg16; png compressed", ".png", red_light<ushort>(kMosaics[2], 40'000));
  ASSERT_EQ(imported().type(), CV_16UC3);
  EXPECT_EQ(imported().at<cv::Vec3w>(2, 4), cv::Vec3w(0, 0, 40'000));
  // A JPEG blurs the mosaic, but the light stays red.
  import_compressed("bayer_rggb8; jpeg compressed", ".jpg", red_light<uchar>(kMosaics[0], 200));
  const cv::Vec3b pixel = imported().at<cv::Vec3b>(2, 4);
  EXPECT_GT(pixel[2], pixel[0] + 60);
}

TEST_P(BagPictures, ACompressedPictureThatIsColourOrGreyIsCopied) {
  const cv::Mat colour(kHeight, kWidth, CV_8UC3, cv::Scalar(20, 40, 200));
  const cv::Mat grey(kHeight, kWidth, CV_8UC1, cv::Scalar(90));
  const std::vector<std::pair<std::string, cv::Mat>> cases{
      {"rgb8; jpeg compressed bgr8", colour},   {"bayer_rggb8; jpeg compressed bgr8", colour},
      {"bayer_rggb8; jpeg compressed", colour}, {"bayer_rggb8; jpeg compressed mono8", grey},
      {"mono8; jpeg compressed ", grey},        {"jpeg", grey}};
  for (const auto& [format, picture] : cases) {
    import_compressed(format, ".jpg", picture);
    EXPECT_EQ(read_file(path(".jpg")), file()) << format;
  }
}

TEST_P(BagPictures, AnUnknownMosaicIsNamed) {
  EXPECT_THAT(test::input_error_of([&] {
                import_compressed("bayer_rgbw8; png compressed", ".png",
                                  red_light<uchar>(kMosaics[0], 200));
              }),
              HasSubstr("topic /cam/image_raw/compressed: encoding 'bayer_rgbw8' is not read"));
}

}  // namespace
}  // namespace fathom
