#include "fathom/vision/features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "flatten.hpp"

namespace fathom {
namespace {

// Smaller than this no detector has room for a descriptor, and some of OpenCV's fail on them. Not
// tuned: a larger picture does not depend on it.
constexpr int kSmallestSide = 32;

bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  const auto key = [](const cv::KeyPoint& k) {
    return std::make_tuple(-k.response, k.pt.y, k.pt.x, k.size, k.angle, k.octave);
  };
  return key(a) < key(b);
}

// Row numbers of keypoints that describe nothing of what the mask hides.
std::vector<int> unmasked(const std::vector<cv::KeyPoint>& keypoints, const cv::Mat& mask) {
  std::vector<int> rows(keypoints.size());
  std::iota(rows.begin(), rows.end(), 0);
  if (mask.empty()) return rows;
  cv::Mat distances_px;
  cv::distanceTransform(mask, distances_px, cv::DIST_L2, cv::DIST_MASK_5);
  std::erase_if(rows, [&](int row) {
    const cv::KeyPoint& keypoint = keypoints[static_cast<std::size_t>(row)];
    const int u = std::clamp(cvRound(keypoint.pt.x), 0, mask.cols - 1);
    const int v = std::clamp(cvRound(keypoint.pt.y), 0, mask.rows - 1);
    return distances_px.at<float>(v, u) <= keypoint.size;
  });
  return rows;
}

// A detector keeps the strongest before any are masked: so many that the rest of the picture should
// have enough of them, twice over.
int asked_features(int max_features, const cv::Mat& mask) {
  if (mask.empty()) return max_features;
  const int seen = cv::countNonZero(mask);
  const double times = seen > 0 ? 2.0 * static_cast<double>(mask.total()) / seen : 0.0;
  return static_cast<int>(std::min(1e6, times * max_features));
}

// Of these the strongest `count`, strongest first.
std::vector<int> strongest(const std::vector<cv::KeyPoint>& keypoints, std::vector<int> order,
                           std::size_t count) {
  std::ranges::stable_sort(order, [&](int a, int b) {
    return stronger(keypoints[static_cast<std::size_t>(a)], keypoints[static_cast<std::size_t>(b)]);
  });
  if (order.size() > count) order.resize(count);
  return order;
}

cv::Mat prepared(const cv::Mat& picture, const FeatureOptions& options,
                 const FeatureTuning& tuning) {
  // OpenCV's filters look beyond the border of a part of a larger picture, and find what is there.
  cv::Mat gray = picture.isSubmatrix() ? picture.clone() : picture;
  if (options.flatten) gray = flattened(gray, tuning);
  if (!options.clahe) return gray;
  cv::Mat equalised;
  cv::createCLAHE(options.clahe_clip_limit, cv::Size(options.clahe_tiles, options.clahe_tiles))
      ->apply(gray, equalised);
  return equalised;
}

}  // namespace

double metres_per_pixel(const CameraModel& camera, double altitude_m) {
  return altitude_m / std::sqrt(camera.fx * camera.fy);
}

FloorFeatures on_floor(Features features, const Camera& camera, double altitude_m,
                       const std::optional<MeasuredTilt>& tilt) {
  const Stance stance(altitude_m, tilt);
  FloorFeatures result;
  result.points = camera.floor_points(features.pixels, stance);
  const CameraModel& model = camera.model();
  const double pixel_m = metres_per_pixel(model, altitude_m);
  for (std::size_t row = 0; row < features.sizes_px.size(); ++row) {
    const Camera::Neighbourhood near =
        camera.neighbourhood(features.pixels[row], features.turns_rad[row], stance.tilt);
    result.sizes_m.push_back(pixel_m * features.sizes_px[row] * near.stretch);
    result.headings_rad.push_back(near.heading_rad);
  }
  result.features = std::move(features);
  result.viewpoint = {{model.mount_x_m, model.mount_y_m}, altitude_m, pixel_m};
  result.viewpoint.pitch_rad = stance.tilt.pitch_rad;
  if (tilt) result.viewpoint.tilt_sigma_rad = tilt->sigma_rad;
  return result;
}

void FeatureOptions::describe(OptionTable& table) {
  std::vector<std::string> names;
  for (const DetectorEntry& entry : detectors()) names.push_back(entry.name);
  table.choice("type", type, names, "keypoint detector and descriptor");
  table.integer("max_features", max_features, Range::between(1, 1e6), "",
                "keypoints kept per picture, the strongest");
  for (const DetectorEntry& entry : detectors()) {
    if (entry.describe) entry.describe(detector, table);
  }
  table.boolean("flatten", flatten,
                "even out light and contrast, and blur sensor noise, before detection");
  table.boolean("clahe", clahe, "equalise contrast locally (CLAHE) before detection");
  table.real("clahe_clip_limit", clahe_clip_limit, Range::positive(), "",
             "CLAHE: greatest slope of the equalisation, times a uniform histogram");
  table.integer("clahe_tiles", clahe_tiles, Range::between(1, 64), "",
                "CLAHE: tiles along each side of the picture");
}

Features FeatureExtractor::extract(const cv::Mat& gray, const cv::Mat& mask) const {
  if (gray.empty() || gray.type() != CV_8UC1) {
    throw InputError("features need a picture of 8 bits and one channel, got " +
                     (gray.empty() ? std::string("an empty one") : cv::typeToString(gray.type())));
  }
  if (!mask.empty() && (mask.size() != gray.size() || mask.type() != CV_8UC1)) {
    throw InputError("features need a mask of 8 bits and of the picture's size");
  }
  Features features;
  if (std::min(gray.cols, gray.rows) < kSmallestSide) return features;

  const int most = asked_features(options_.max_features, mask);
  if (most == 0) return features;
  const Detector detector = find_detector(options_.type).make(options_.detector, most);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  detector.finder->detectAndCompute(prepared(gray, options_, tuning_), cv::noArray(), keypoints,
                                    descriptors);

  const std::vector<int> order = strongest(keypoints, unmasked(keypoints, mask),
                                           static_cast<std::size_t>(options_.max_features));
  features.pixels.reserve(order.size());
  if (!order.empty()) {
    features.descriptors.create(static_cast<int>(order.size()), descriptors.cols,
                                descriptors.type());
  }
  for (std::size_t row = 0; row < order.size(); ++row) {
    const cv::KeyPoint& keypoint = keypoints[static_cast<std::size_t>(order[row])];
    const cv::Point2f& point = keypoint.pt;
    features.pixels.emplace_back(point.x - detector.offset_px, point.y - detector.offset_px);
    features.sizes_px.push_back(keypoint.size);
    features.turns_rad.push_back(static_cast<float>(keypoint.angle * std::numbers::pi / 180.0));
    descriptors.row(order[row]).copyTo(features.descriptors.row(static_cast<int>(row)));
  }
  return features;
}

}  // namespace fathom
