#include "fathom/vision/detectors.hpp"

#include <opencv2/features2d.hpp>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

// OpenCV's SIFT doubles the picture by cv::resize, which puts pixel i of the original at 2 i + 0.5,
// and reads positions back as if it were at 2 i: all its keypoints are a quarter of a pixel too far
// right and down. Unseen as long as the heading stays; turned by 180° it makes half a pixel.
Detector make_sift(const DetectorOptions& options, int max_features) {
  const SiftOptions& sift = options.sift;
  return {cv::SIFT::create(max_features, sift.octave_layers, sift.contrast, sift.edge_threshold,
                           sift.sigma_px),
          sift.offset_px};
}

void describe_sift(DetectorOptions& options, OptionTable& table) {
  SiftOptions& sift = options.sift;
  table.real("sift_contrast", sift.contrast, Range{1e-4, 1.0}, "",
             "SIFT: least contrast of a keypoint, as a share of the grey range (OpenCV: 0.04)");
  table.integer("sift_octave_layers", sift.octave_layers, Range::between(1, 20), "",
                "SIFT: layers of an octave (Lowe 2004, section 3.2)");
  table.real("sift_edge_threshold", sift.edge_threshold, Range{1.0, 1e3, true}, "",
             "SIFT: greatest ratio of principal curvatures (Lowe 2004, section 4.1)");
  table.real("sift_sigma_px", sift.sigma_px, Range{0.5, 100.0, true}, "pixels",
             "SIFT: blur of the first layer (Lowe 2004, section 3.3)");
  table.real("sift_offset_px", sift.offset_px, Range::between(-1.0, 1.0), "pixels",
             "SIFT: taken off each coordinate; OpenCV's resize puts keypoints so far off");
}

}  // namespace

const std::vector<DetectorEntry>& detectors() {
  static const std::vector<DetectorEntry> entries{
      {"sift", "SIFT (Lowe 2004), 128 numbers; the most reliable, the slowest", make_sift,
       describe_sift},
      {"orb",
       "ORB (Rublee et al. 2011), 256 bits; by far the fastest",
       [](const DetectorOptions&, int max_features) {
         return Detector{cv::ORB::create(max_features)};
       },
       {}},
      {"akaze",
       "AKAZE with M-LDB (Alcantarilla et al. 2013), 486 bits",
       [](const DetectorOptions&, int) { return Detector{cv::AKAZE::create()}; },
       {}},
      {"brisk",
       "BRISK (Leutenegger et al. 2011), 512 bits",
       [](const DetectorOptions&, int) { return Detector{cv::BRISK::create()}; },
       {}},
  };
  return entries;
}

const DetectorEntry& find_detector(const std::string& name) {
  std::vector<std::string> names;
  for (const DetectorEntry& entry : detectors()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw InputError("unknown detector '" + name + "'" + suggestion(name, names));
}

}  // namespace fathom
