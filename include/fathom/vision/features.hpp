#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/core/options.hpp"
#include "fathom/vision/camera.hpp"
#include "fathom/vision/detectors.hpp"
#include "fathom/vision/registration_tuning.hpp"

namespace fathom {

/// Keypoints and descriptors of one picture.
struct Features {
  std::vector<Eigen::Vector2d> pixels;  ///< (u, v); (0, 0) is the centre of the first pixel
  std::vector<float> sizes_px;          ///< diameter of what a keypoint describes
  std::vector<float> turns_rad;         ///< its orientation in the picture, from +u towards +v
  cv::Mat descriptors;                  ///< one row per keypoint: CV_32F (SIFT) or CV_8U (binary)

  std::size_t size() const { return pixels.size(); }
};

/// From where a picture of the floor was taken.
struct Viewpoint {
  Eigen::Vector2d camera_m = Eigen::Vector2d::Zero();  ///< the point below the camera, body frame
  double altitude_m = 0.0;
  double metres_per_pixel = 0.0;
  double pitch_rad = 0.0;         ///< about which a roll is turned
  double altitude_sigma_m = 0.0;  ///< as its sensor states it, if more than CovarianceOptions has
  /// Of roll and of pitch where they are measured; CovarianceOptions has that of the others.
  std::optional<double> tilt_sigma_rad = std::nullopt;
};

/// Features with their points in metres on the floor: what registration works on. The conversion is
/// per picture, with that picture's altitude, roll and pitch.
struct FloorFeatures {
  std::vector<Eigen::Vector2d> points;  ///< body frame, metres
  std::vector<double> sizes_m;          ///< of the keypoints, on the floor
  std::vector<double> headings_rad;     ///< of their orientations, body frame
  Features features;
  Viewpoint viewpoint;

  std::size_t size() const { return points.size(); }
};

/// How wide a pixel is on the floor: altitude over focal length, the geometric mean of both.
double metres_per_pixel(const CameraModel& camera, double altitude_m);

/// Of a camera whose roll and pitch are measured, or that is taken for level. Throws InputError on
/// an altitude that is not positive.
FloorFeatures on_floor(Features features, const Camera& camera, double altitude_m,
                       const std::optional<MeasuredTilt>& tilt = std::nullopt);

struct FeatureOptions {
  std::string type = "sift";  ///< name of a detector (detectors.hpp)
  int max_features = 2000;
  DetectorOptions detector;
  /// Every pixel less the mean about it, over the deviation there (docs/registration.md).
  bool flatten = true;
  bool clahe = false;
  double clahe_clip_limit = 3.0;
  int clahe_tiles = 8;

  void describe(OptionTable& table);
};

/// Finds and describes keypoints. May be used from several threads at once; the same picture gives
/// the same features, in the same order, whatever the number of threads.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const FeatureOptions& options = {}, const FeatureTuning& tuning = {})
      : options_(options), tuning_(tuning) {}

  /// The `max_features` features with the strongest response, strongest first; equal ones in the
  /// order of their place in the picture, then size and orientation. A keypoint with several
  /// orientations counts as several. A picture without texture, or too small to hold a keypoint
  /// (under 32 pixels a side), has none. `mask`, of the picture's size: no feature is kept within
  /// its own size of a pixel that is 0 there. Throws InputError unless `gray` is 8-bit with one
  /// channel and not empty, or where the mask does not fit it.
  Features extract(const cv::Mat& gray, const cv::Mat& mask = {}) const;

 private:
  FeatureOptions options_;
  FeatureTuning tuning_;
};

}  // namespace fathom
