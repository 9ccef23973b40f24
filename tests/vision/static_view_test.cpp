// What stays in place in pictures of one camera. Floors, overlays and faults are drawn here, with
// OpenCV alone.

#include "fathom/vision/static_view.hpp"

#include <functional>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/vision/picture_codecs.hpp"
#include "vision/textured_floor.hpp"

namespace fathom {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
using Change = std::function<void(cv::Mat&, int)>;

// From sixteen places of a floor, 0.6 m apart along a bend.
std::vector<cv::Mat> sixteen_places() {
  static const TexturedFloor floor(1500, 0.004, 3);
  CameraModel model;
  model.width = kWidth;
  model.height = kHeight;
  model.fx = model.fy = 300.0;
  model.cx = 159.5;
  model.cy = 119.5;
  const Camera camera(model);
  std::vector<cv::Mat> pictures;
  Pose pose{-1.5, -1.0, 0.2};
  for (int i = 0; i < 16; ++i) {
    pictures.push_back(floor.seen(camera, pose, 1.2));
    pose = compose(pose, {0.6, 0.0, 0.35});
  }
  return pictures;
}

StaticView view_of(const std::vector<cv::Mat>& pictures) {
  std::vector<cv::Mat> details;
  for (const cv::Mat& picture : pictures) details.push_back(detail_of_view(picture));
  return find_static_view(details, pictures.front().size());
}

StaticView view_of_changed(const Change& change) {
  std::vector<cv::Mat> pictures = sixteen_places();
  for (std::size_t i = 0; i < pictures.size(); ++i) change(pictures[i], static_cast<int>(i));
  return view_of(pictures);
}

void expect_nothing(const StaticView& view) {
  EXPECT_TRUE(view.is_told);
  EXPECT_TRUE(view.mask.empty());
}

// Squares of random greys.
cv::Mat blocks(cv::Size size) {
  cv::RNG random(7);
  cv::Mat small(size.height / 4, size.width / 4, CV_8U);
  random.fill(small, cv::RNG::UNIFORM, 30, 220);
  cv::Mat large;
  cv::resize(small, large, size, 0, 0, cv::INTER_NEAREST);
  return large;
}

void add_sensor_noise(cv::Mat& picture, int seed, double sigma) {
  cv::RNG random(static_cast<std::uint64_t>(seed + 1));
  cv::Mat noise(picture.size(), CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
  cv::Mat sum;
  picture.convertTo(sum, CV_32F);
  sum += noise;
  sum.convertTo(picture, CV_8U);
}

void write_text(cv::Mat& picture, int i) {
  const std::vector<std::string> lines{
      "ROV FALCON 12  DIVE 42", cv::format("2026-03-01 10:%02d:%02d", i / 3 + 7, 7 * i % 60),
      cv::format("DEPTH %.1f m ALT %.2f m", 23.0 + 0.3 * i, 2.0 + 0.01 * (i % 7)),
      cv::format("HDG %03d PITCH %+03d", i * 37 % 360, i % 5 - 2)};
  for (std::size_t line = 0; line < lines.size(); ++line) {
    cv::putText(picture, lines[line], {6, 14 + 14 * static_cast<int>(line)},
                cv::FONT_HERSHEY_SIMPLEX, 0.4, cv::Scalar(240), 1, cv::LINE_AA);
  }
}

TEST(StaticView, ABarBelowIsFoundAndNothingElse) {
  constexpr int kBar = 29;  // 12 % of 240
  const cv::Mat bar = blocks({kWidth, 28});
  const StaticView view = view_of_changed(
      [&](cv::Mat& picture, int) { bar.copyTo(picture.rowRange(kHeight - 28, kHeight)); });
  ASSERT_EQ(view.mask.size(), cv::Size(kWidth, kHeight));
  EXPECT_EQ(view.mask.type(), CV_8U);
  EXPECT_LE(cv::countNonZero(view.mask.rowRange(kHeight - kBar + 4, kHeight)), 0);
  // Flattening and the window reach some pixels beyond its edge, no more.
  EXPECT_EQ(cv::countNonZero(view.mask.rowRange(0, kHeight - kBar - 24)),
            kWidth * (kHeight - kBar - 24));
  EXPECT_NEAR(masked_share(view.mask), 0.12, 0.06);
  EXPECT_TRUE(masked_where(view.mask).starts_with("the lowest 1")) << masked_where(view.mask);
}

TEST(StaticView, FourLinesOfTextAreFound) {
  const StaticView view = view_of_changed(write_text);
  ASSERT_FALSE(view.mask.empty());
  // Where the first and the last line have their constant words.
  EXPECT_EQ(view.mask.at<unsigned char>(10, 60), 0);
  EXPECT_EQ(view.mask.at<unsigned char>(52, 15), 0);
  EXPECT_EQ(cv::countNonZero(view.mask.rowRange(90, kHeight)), kWidth * (kHeight - 90));
  EXPECT_TRUE(masked_where(view.mask).starts_with("the uppermost ")) << masked_where(view.mask);
}

TEST(StaticView, SpotsOfDirtAreFoundOneByOne) {
  const StaticView view = view_of_changed([](cv::Mat& picture, int) {
    for (const cv::Point at : {cv::Point(80, 100), cv::Point(200, 140), cv::Point(150, 60)}) {
      cv::circle(picture, at, 8, cv::Scalar(20), cv::FILLED, cv::LINE_AA);
    }
  });
  ASSERT_FALSE(view.mask.empty());
  EXPECT_EQ(view.mask.at<unsigned char>(100, 80), 0);
  EXPECT_EQ(masked_where(view.mask), "3 parts");
}

TEST(StaticView, CleanPicturesHaveNothing) {
  expect_nothing(view_of(sixteen_places()));
}

TEST(StaticView, NeitherVignettingNorALampStays) {
  cv::Mat light(kHeight, kWidth, CV_32F);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double r = std::hypot(u - 159.5, v - 119.5) / 200.0;
      const double lamp = std::exp(-0.5 * std::pow(std::hypot(u - 200.0, v - 80.0) / 60.0, 2));
      light.at<float>(v, u) = static_cast<float>(0.3 * (1.0 - 0.6 * r * r) + 0.7 * lamp);
    }
  }
  expect_nothing(view_of_changed([&](cv::Mat& picture, int) {
    cv::Mat lit;
    picture.convertTo(lit, CV_32F);
    lit = lit.mul(light);
    lit.convertTo(picture, CV_8U);
  }));
}

TEST(StaticView, NeitherJpegBlocksNorAFaintFloorStay) {
  const auto compress = [](cv::Mat& picture, int quality) {
    picture = decode_picture(encode_picture(".jpg", picture, {cv::IMWRITE_JPEG_QUALITY, quality}),
                             cv::IMREAD_GRAYSCALE);
  };
  expect_nothing(view_of_changed([&](cv::Mat& picture, int) { compress(picture, 10); }));
  for (const int quality : {10, 50}) {
    expect_nothing(view_of_changed([&](cv::Mat& picture, int i) {
      picture.convertTo(picture, CV_8U, 0.05, 100.0);
      add_sensor_noise(picture, i, 0.5);
      compress(picture, quality);
    }));
  }
}

TEST(StaticView, OfAVehicleAtRestNothingCanBeTold) {
  const std::vector<cv::Mat> all = sixteen_places();
  for (const double sigma : {0.0, 4.0, 12.0}) {
    std::vector<cv::Mat> pictures(16);
    for (int i = 0; i < 16; ++i) {
      pictures[static_cast<std::size_t>(i)] = all.front().clone();
      add_sensor_noise(pictures[static_cast<std::size_t>(i)], i, sigma);
    }
    const StaticView view = view_of(pictures);
    EXPECT_TRUE(view.mask.empty()) << sigma;
    EXPECT_FALSE(view.is_told) << sigma;
  }
}

TEST(StaticView, APartOfTheSurveyAtRestMasksNothing) {
  for (const int rest : {4, 8, 11}) {
    for (const double sigma : {2.0, 12.0}) {
      std::vector<cv::Mat> pictures = sixteen_places();
      for (int i = 0; i < rest; ++i) {
        cv::Mat& picture = pictures[static_cast<std::size_t>(i)];
        picture = pictures.front().clone();
        if (i > 0) add_sensor_noise(picture, i, sigma);
      }
      EXPECT_TRUE(view_of(pictures).mask.empty()) << rest << " " << sigma;
    }
  }
}

TEST(StaticView, FewPicturesDoNotTell) {
  std::vector<cv::Mat> pictures = sixteen_places();
  pictures.resize(5);
  EXPECT_FALSE(view_of(pictures).is_told);
  EXPECT_FALSE(find_static_view({}, {kWidth, kHeight}).is_told);
}

TEST(StaticView, HalfThePicturesSayWhetherTheOthersAreNeeded) {
  std::vector<cv::Mat> plain;
  std::vector<cv::Mat> with_text;
  int i = 0;
  for (cv::Mat& picture : sixteen_places()) {
    if (++i % 2 == 0) continue;
    plain.push_back(detail_of_view(picture));
    write_text(picture, i);
    with_text.push_back(detail_of_view(picture));
  }
  EXPECT_FALSE(may_have_static_view(plain));
  EXPECT_TRUE(may_have_static_view(with_text));
}

TEST(StaticView, AMaskHasThePicturesSizeThoughLargeOnesAreReduced) {
  std::vector<cv::Mat> pictures = sixteen_places();
  for (cv::Mat& picture : pictures) {
    cv::resize(picture, picture, {1283, 961}, 0, 0, cv::INTER_CUBIC);
    blocks({1280, 120}).copyTo(picture(cv::Rect(0, 0, 1280, 120)));
  }
  const StaticView view = view_of(pictures);
  ASSERT_EQ(view.mask.size(), cv::Size(1283, 961));
  EXPECT_TRUE(masked_where(view.mask).starts_with("the uppermost 1")) << masked_where(view.mask);
}

}  // namespace
}  // namespace fathom
