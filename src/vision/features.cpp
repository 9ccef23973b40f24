#include "fathom/vision/features.hpp"

#include <algorithm>
#include <array>
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

cv::Mat prepared(const cv::Mat& picture, const FeatureOptions& options) {
  // OpenCV's filters look beyond the border of a part of a larger picture, and find what is there.
  cv::Mat gray = picture.isSubmatrix() ? picture.clone() : picture;
  if (!options.clahe) return gray;
  cv::Mat equalised;
  cv::createCLAHE(options.clahe_clip_limit, cv::Size(options.clahe_tiles, options.clahe_tiles))
      ->apply(gray, equalised);
  return equalised;
}

}  // namespace

FloorFeatures on_floor(Features features, const Camera& camera, double altitude_m) {
  std::vector<Eigen::Vector2d> points = camera.floor_points(features.pixels, altitude_m);
  return {std::move(points), std::move(features)};
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
    const cv::Point2f& point = keypoints[static_cast<std::size_t>(order[row])].pt;
    features.pixels.emplace_back(point.x - offset, point.y - offset);
    descriptors.row(order[row]).copyTo(features.descriptors.row(static_cast<int>(row)));
  }
  return features;
}

}  // namespace fathom
