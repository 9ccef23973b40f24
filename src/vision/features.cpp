#include "fathom/vision/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

// Smaller than this no detector has room for a descriptor, and some of OpenCV's fail on them.
constexpr int kSmallestSide = 32;

// OpenCV's SIFT doubles the picture by cv::resize, which puts pixel i of the original at 2 i + 0.5,
// and reads positions back as if it were at 2 i: all its keypoints are a quarter of a pixel too far
// right and down. Unseen as long as the heading stays; turned by 180° it makes half a pixel.
constexpr double kSiftOffset = 0.25;

cv::Ptr<cv::Feature2D> make_detector(const FeatureOptions& options) {
  switch (options.type) {
    case FeatureType::orb:
      return cv::ORB::create(options.max_features);
    case FeatureType::akaze:
      return cv::AKAZE::create();
    case FeatureType::brisk:
      return cv::BRISK::create();
    case FeatureType::sift:
      break;
  }
  constexpr int kOctaveLayers = 3;
  constexpr double kEdgeThreshold = 10.0;
  return cv::SIFT::create(options.max_features, kOctaveLayers, options.sift_contrast,
                          kEdgeThreshold);
}

bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  const auto key = [](const cv::KeyPoint& k) {
    return std::make_tuple(-k.response, k.pt.y, k.pt.x, k.size, k.angle, k.octave);
  };
  return key(a) < key(b);
}

// Row numbers of the strongest `count` keypoints, strongest first.
std::vector<int> strongest(const std::vector<cv::KeyPoint>& keypoints, std::size_t count) {
  std::vector<int> order(keypoints.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](int a, int b) {
    return stronger(keypoints[static_cast<std::size_t>(a)], keypoints[static_cast<std::size_t>(b)]);
  });
  if (order.size() > count) order.resize(count);
  return order;
}

// Twice a box, near enough a Gaussian of this radius, at a cost that does not grow with it.
cv::Mat smoothed(const cv::Mat& picture, int radius_px) {
  const cv::Size box(2 * radius_px + 1, 2 * radius_px + 1);
  cv::Mat once;
  cv::Mat twice;
  cv::boxFilter(picture, once, CV_32F, box, {-1, -1}, true, cv::BORDER_REFLECT_101);
  cv::boxFilter(once, twice, CV_32F, box, {-1, -1}, true, cv::BORDER_REFLECT_101);
  return twice;
}

double deviation_of(const cv::Mat& picture) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture, mean, deviation);
  return deviation[0];
}

cv::Mat blurred(const cv::Mat& picture, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(picture, result, {}, sigma_px);
  return result;
}

// The blur that leaves less of a sensor's noise than there is of the floor, 0 where that is so
// already. Noise is told by the scale: it is strongest from pixel to pixel, where a floor seen
// through a lens has little, no more than in the band of 1 to 2 pixels.
double blur_for_noise(const cv::Mat& picture) {
  // Of white noise of deviation 1: what the finest band and that of 1 to 2 pixels have of it. Of a
  // floor the finest has some 0.6 of the other.
  constexpr double kFineShare = 0.72;
  constexpr double kMiddleShare = 0.14;
  constexpr double kFloorRatio = 0.6;
  const auto square = [](double x) { return x * x; };
  const double fine = square(deviation_of(picture - blurred(picture, 0.7)));
  const double middle = square(deviation_of(blurred(picture, 1.0) - blurred(picture, 2.0)));
  const double noise = std::sqrt(std::max(0.0, fine - square(kFloorRatio) * middle) /
                                 (square(kFineShare) - square(kFloorRatio * kMiddleShare)));
  const double floor = std::sqrt(std::max(0.0, middle - square(kMiddleShare * noise)));
  // A Gaussian blur of sigma leaves 1 / (2 √π sigma) of the noise.
  constexpr double kLeft = 0.8;
  constexpr double kMost = 2.5;
  const double sigma = noise / (2.0 * std::sqrt(std::numbers::pi) * kLeft * std::max(floor, 0.1));
  return sigma < 0.4 ? 0.0 : std::min(sigma, kMost);
}

// Every pixel less the mean about it, over the standard deviation there: light, shade and haze that
// vary slowly are gone, and a faint floor is as rich in contrast as a bold one.
cv::Mat flattened(const cv::Mat& gray) {
  constexpr double kSharpPx = 6.0;
  constexpr double kWider = 4.0;
  constexpr double kRounding = 1.0;  // of a grey: below it nothing is amplified
  constexpr double kDeviation = 40.0;
  constexpr double kMiddle = 128.0;
  cv::Mat detail;
  gray.convertTo(detail, CV_32F);
  const double blur_px = blur_for_noise(detail);
  if (blur_px > 0.0) detail = blurred(detail, blur_px);
  const int radius_px = cvRound(kSharpPx + kWider * blur_px);
  detail -= smoothed(detail, radius_px);
  cv::Mat deviation;
  cv::sqrt(smoothed(detail.mul(detail), radius_px), deviation);
  detail /= deviation + kRounding;
  cv::Mat flat;
  detail.convertTo(flat, CV_8U, kDeviation, kMiddle);
  return flat;
}

cv::Mat prepared(const cv::Mat& picture, const FeatureOptions& options) {
  // OpenCV's filters look beyond the border of a part of a larger picture, and find what is there.
  cv::Mat gray = picture.isSubmatrix() ? picture.clone() : picture;
  if (options.flatten) gray = flattened(gray);
  if (!options.clahe) return gray;
  cv::Mat equalised;
  cv::createCLAHE(options.clahe_clip_limit, cv::Size(options.clahe_tiles, options.clahe_tiles))
      ->apply(gray, equalised);
  return equalised;
}

}  // namespace

FloorFeatures on_floor(Features features, const Camera& camera, double altitude_m) {
  FloorFeatures result;
  result.points = camera.floor_points(features.pixels, altitude_m);
  const CameraModel& model = camera.model();
  const double metres_per_pixel = altitude_m / std::sqrt(model.fx * model.fy);
  for (std::size_t row = 0; row < features.sizes_px.size(); ++row) {
    result.sizes_m.push_back(metres_per_pixel * features.sizes_px[row]);
    result.headings_rad.push_back(camera.heading(features.turns_rad[row]));
  }
  result.features = std::move(features);
  result.viewpoint = {{model.mount_x_m, model.mount_y_m}, altitude_m, metres_per_pixel};
  return result;
}

std::span<const DetectorEntry> detectors() {
  static const std::array<DetectorEntry, 4> entries{{
      {"sift", FeatureType::sift, "SIFT (Lowe 2004), 128 numbers; the most reliable, the slowest"},
      {"orb", FeatureType::orb, "ORB (Rublee et al. 2011), 256 bits; by far the fastest"},
      {"akaze", FeatureType::akaze, "AKAZE with M-LDB (Alcantarilla et al. 2013), 486 bits"},
      {"brisk", FeatureType::brisk, "BRISK (Leutenegger et al. 2011), 512 bits"},
  }};
  return entries;
}

void FeatureOptions::describe(OptionTable& table) {
  std::vector<std::pair<std::string, FeatureType>> names;
  for (const DetectorEntry& entry : detectors()) names.emplace_back(entry.name, entry.type);
  table.enumeration("type", type, names, "keypoint detector and descriptor");
  table.integer("max_features", max_features, Range::between(1, 1e6), "",
                "keypoints kept per picture, the strongest");
  table.real("sift_contrast", sift_contrast, Range{1e-4, 1.0}, "",
             "SIFT: least contrast of a keypoint, as a share of the grey range (OpenCV: 0.04)");
  table.boolean("flatten", flatten,
                "even out light and contrast, and blur sensor noise, before detection");
  table.boolean("clahe", clahe, "equalise contrast locally (CLAHE) before detection");
  table.real("clahe_clip_limit", clahe_clip_limit, Range::positive(), "",
             "CLAHE: greatest slope of the equalisation, times a uniform histogram");
  table.integer("clahe_tiles", clahe_tiles, Range::between(1, 64), "",
                "CLAHE: tiles along each side of the picture");
}

Features FeatureExtractor::extract(const cv::Mat& gray) const {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw InputError("features need a picture of 8 bits and one channel, got " +
                     (gray.empty() ? std::string("an empty one") : cv::typeToString(gray.type())));
  }
  Features features;
  if (std::min(gray.cols, gray.rows) < kSmallestSide) return features;

  // A detector of OpenCV keeps state between calls, so each call has its own; making one is cheap.
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  make_detector(options_)->detectAndCompute(prepared(gray, options_), cv::noArray(), keypoints,
                                            descriptors);

  const double offset = options_.type == FeatureType::sift ? kSiftOffset : 0.0;
  const std::vector<int> order =
      strongest(keypoints, static_cast<std::size_t>(options_.max_features));
  features.pixels.reserve(order.size());
  if (!order.empty()) {
    features.descriptors.create(static_cast<int>(order.size()), descriptors.cols,
                                descriptors.type());
  }
  for (std::size_t row = 0; row < order.size(); ++row) {
    const cv::KeyPoint& keypoint = keypoints[static_cast<std::size_t>(order[row])];
    const cv::Point2f& point = keypoint.pt;
    features.pixels.emplace_back(point.x - offset, point.y - offset);
    features.sizes_px.push_back(keypoint.size);
    features.turns_rad.push_back(static_cast<float>(keypoint.angle * std::numbers::pi / 180.0));
    descriptors.row(order[row]).copyTo(features.descriptors.row(static_cast<int>(row)));
  }
  return features;
}

}  // namespace fathom
