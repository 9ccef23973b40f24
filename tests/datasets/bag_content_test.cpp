// Pictures, cameras, altitudes and covariances of bags, one by one.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "support/pictures.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

using test::kBegin;
using test::kSecond;

test::Stamps at(double seconds) {
  const std::int64_t time_ns = kBegin + std::llround(seconds * 1e9);
  return {time_ns, time_ns};
}

test::CameraInformation information(std::uint32_t width = 4, std::uint32_t height = 2) {
  test::CameraInformation info;
  info.width = width;
  info.height = height;
  info.K = {10, 0, 1.5, 0, 12, 0.5, 0, 0, 1};
  info.P = {20, 0, 3.5, 0, 0, 24, 2.5, 0, 0, 0, 1, 0};
  info.D = {0.01, 0, 0, 0, 0};
  return info;
}

test::RawImage image(const std::string& encoding, std::uint32_t bytes_a_pixel) {
  test::RawImage raw;
  raw.encoding = encoding;
  raw.width = 4;
  raw.height = 2;
  raw.step = raw.width * bytes_a_pixel + 5;
  raw.data.resize(std::size_t{raw.step} * raw.height);
  for (std::size_t i = 0; i < raw.data.size(); ++i) raw.data[i] = static_cast<std::uint8_t>(7 * i);
  return raw;
}

class BagContent : public test::BagTest {
 protected:
  cv::Mat first_picture(const std::string& ending = ".png") const {
    const std::string name = std::to_string(kBegin) + ending;
    return test::read_picture(out() / "mav0" / "cam0" / "data" / name, cv::IMREAD_UNCHANGED);
  }
  void import_one(const test::RawImage& raw) const {
    {
      const auto bag = writer();
      bag->camera_info("/cam/camera_info", at(0), information());
      bag->image("/cam/image_raw", at(0), raw);
    }
    BagImportOptions options;
    options.altitude_m = 2.0;
    import(options);
  }
  std::string odometry_rows() const { return read_file(out() / "mav0" / "odometry0" / "data.csv"); }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagContent, ::testing::Values(1, 2), test::generation);

TEST_P(BagContent, ColoursKeepTheirPlaces) {
  const test::RawImage raw = image("rgb8", 3);
  import_one(raw);
  const cv::Mat picture = first_picture();
  ASSERT_EQ(picture.type(), CV_8UC3);
  const std::size_t pixel = raw.step + 3 * 2;  // row 1, column 2
  const auto bgr = picture.at<cv::Vec3b>(1, 2);
  EXPECT_EQ(bgr[2], raw.data[pixel]);
  EXPECT_EQ(bgr[0], raw.data[pixel + 2]);
}

TEST_P(BagContent, AlphaIsLeftOut) {
  const test::RawImage raw = image("bgra8", 4);
  import_one(raw);
  ASSERT_EQ(first_picture().type(), CV_8UC3);
  EXPECT_EQ(first_picture().at<cv::Vec3b>(0, 1)[0], raw.data[4]);
}

TEST_P(BagContent, SixteenBitsOfEitherByteOrder) {
  test::RawImage raw = image("mono16", 2);
  raw.is_bigendian = true;
  import_one(raw);
  ASSERT_EQ(first_picture().type(), CV_16UC1);
  EXPECT_EQ(first_picture().at<ushort>(0, 1), raw.data[2] * 256 + raw.data[3]);
}

TEST_P(BagContent, MosaicOfRedInTheCornerBecomesColour) {
  test::RawImage raw = image("bayer_rggb8", 1);
  raw.width = 8;
  raw.height = 6;
  raw.step = 8;
  raw.data.assign(48, 0);
  for (std::size_t v = 0; v < 6; v += 2) {
    for (std::size_t u = 0; u < 8; u += 2) raw.data[8 * v + u] = 200;  // the red ones
  }
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information(8, 6));
    bag->image("/cam/image_raw", at(0), raw);
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  import(options);
  const auto bgr = first_picture().at<cv::Vec3b>(2, 4);
  EXPECT_EQ(bgr[2], 200);
  EXPECT_EQ(bgr[0], 0);
}

TEST_P(BagContent, CompressedPicturesAreCopied) {
  const cv::Mat picture(2, 4, CV_8UC1, cv::Scalar(90));
  const std::string bytes = encode_picture(".jpg", picture);
  std::vector<std::uint8_t> jpeg(bytes.begin(), bytes.end());
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    bag->compressed_image("/cam/image_raw/compressed", at(0), "jpeg", jpeg);
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  import(options);
  const std::string name = std::to_string(kBegin) + ".jpg";
  EXPECT_EQ(read_file(out() / "mav0" / "cam0" / "data" / name),
            std::string(jpeg.begin(), jpeg.end()));
  {
    std::filesystem::remove(bag());
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    jpeg.resize(jpeg.size() / 2);
    bag->compressed_image("/cam/image_raw/compressed", at(0), "jpeg", jpeg);
  }
  EXPECT_THAT(refusal(options), HasSubstr("topic /cam/image_raw/compressed"));
}

TEST_P(BagContent, BinnedRegionHasItsOwnCamera) {
  {
    const auto bag = writer();
    test::CameraInformation info = information(64, 48);
    info.K = {100, 0, 31.5, 0, 100, 23.5, 0, 0, 1};
    info.binning = 2;
    info.x_offset = 28;
    info.y_offset = 22;
    info.region_width = 8;
    info.region_height = 4;
    bag->camera_info("/cam/camera_info", at(0), info);
    bag->image("/cam/image_raw", at(0), image("mono8", 1));
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  import(options);
  const CameraModel model = ImageFolder(out()).camera().model();
  EXPECT_EQ(model.fx, 50.0);
  // The middle of the sensor is that of the region and of the picture.
  EXPECT_EQ(model.cx, 1.5);
  EXPECT_EQ(model.cy, 0.5);
}

TEST_P(BagContent, RectifiedPicturesHaveTheCameraOfP) {
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    bag->image("/cam/image_rect", at(0), image("mono8", 1));
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  EXPECT_THAT(import(options).notes, Contains(HasSubstr("rectified")));
  const CameraModel model = ImageFolder(out()).camera().model();
  EXPECT_EQ(model.fx, 20.0);
  EXPECT_EQ(model.cy, 2.5);
  EXPECT_FALSE(model.has_distortion());
}

TEST_P(BagContent, RangesThatAreNoneAndPicturesWithoutThemAreLeftOut) {
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 8; ++i) {
      const float range = i == 3 ? kInfinity : i == 4 ? 0.05F : 2.5F;
      bag->image("/cam/image_raw", at(i), image("mono8", 1));
      if (i > 0) bag->range("/sonar", at(i + 0.1), {range, 0.2F, 30.0F});
    }
  }
  const ImportReport report = import();
  EXPECT_THAT(report.notes, AllOf(Contains(HasSubstr("2 altitudes left out")),
                                  // 0 and 1 lie before the first range, 3 to 5 in a gap of 3 s.
                                  Contains(HasSubstr("5 of the pictures left out"))));
  EXPECT_EQ(ImageFolder(out()).size(), 3U);
}

TEST_P(BagContent, CovarianceOfVelocityWhereThatOfThePoseDoesNotGrow) {
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    for (int i = 0; i < 3; ++i) {
      bag->image("/cam/image_raw", at(0.5 * i), image("mono8", 1));
      test::BodyPose body;
      body.position = {0.2 * i, 0.0, 0.0};
      body.velocity_covariance[0] = 0.04;
      body.velocity_covariance[7] = 0.01;
      body.velocity_covariance[35] = 0.0025;
      bag->odometry("/odom", at(0.5 * i), body);
    }
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  EXPECT_THAT(import(options).notes, Contains(HasSubstr("the covariance of its velocity")));
  const Eigen::Matrix3d C = ImageFolder(out()).info(1).motion->covariance;
  // dt² is 1/4.
  EXPECT_NEAR(C(0, 0), 0.01, 1e-12);
  EXPECT_NEAR(C(1, 1), 0.0025, 1e-12);
  EXPECT_NEAR(C(2, 2), 0.000625, 1e-12);
  options.odometry_sigma_m = 0.3;
  import(options);
  EXPECT_NEAR(ImageFolder(out()).info(1).motion->covariance(0, 0), 0.045, 1e-12);
}

TEST_P(BagContent, CovarianceThatIsNoneIsSaid) {
  {
    const auto bag = writer();
    bag->camera_info("/cam/camera_info", at(0), information());
    for (int i = 0; i < 3; ++i) {
      bag->image("/cam/image_raw", at(i), image("mono8", 1));
      bag->odometry("/odom", at(i), {});
    }
  }
  BagImportOptions options;
  options.altitude_m = 2.0;
  EXPECT_THAT(import(options).notes, Contains(AllOf(HasSubstr("none that could be one"),
                                                    HasSubstr("--odometry-sigma-m"))));
  EXPECT_NEAR(ImageFolder(out()).info(1).motion->covariance(2, 2), 1e-4, 1e-12);
}

}  // namespace
}  // namespace fathom
