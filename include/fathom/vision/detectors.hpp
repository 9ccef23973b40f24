#pragma once

#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/core/options.hpp"

namespace cv {
class Feature2D;
}

namespace fathom {

struct SiftOptions {
  /// Well below OpenCV's 0.04: on a real floor of even sand that leaves 13 to 100 keypoints a
  /// picture, too few to register consecutive frames.
  double contrast = 0.01;
  int octave_layers = 3;
  double edge_threshold = 10.0;
  double sigma_px = 1.6;
  double offset_px = 0.25;
};

/// What one detector alone has, for all detectors.
struct DetectorOptions {
  SiftOptions sift;
};

/// A detector ready for one picture.
struct Detector {
  cv::Ptr<cv::Feature2D> finder;
  /// How far its keypoints lie too far right and down; taken off.
  double offset_px = 0.0;
};

/// Keypoints with descriptors, Euclidean (CV_32F) or binary (CV_8U).
struct DetectorEntry {
  std::string name;  ///< the word of `features.type`
  std::string help;  ///< one line
  /// A new one, as it keeps state between calls; making one is cheap.
  std::function<Detector(const DetectorOptions&, int max_features)> make;
  /// Binds its own options, if it has any, to keys that begin with its name.
  std::function<void(DetectorOptions&, OptionTable&)> describe;
};

/// All detectors: the one place from which `fathom list`, the configuration and the tests of every
/// detector take them. To add one: its entry in detectors.cpp, and in this file its options.
const std::vector<DetectorEntry>& detectors();

/// Throws InputError naming the nearest known one.
const DetectorEntry& find_detector(const std::string& name);

}  // namespace fathom
