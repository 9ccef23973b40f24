#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/report/mosaic.hpp"
#include "floor_map.hpp"
#include "zeroed_pixels.hpp"

namespace fathom {

/// A mosaic, or a window of it, as it accumulates: weighted sums of grey levels, 8 bytes a pixel.
/// A pixel of a window has the same bits as of the whole: nothing is computed from where the window
/// begins.
class Blend {
 public:
  /// `window`: pixels of the plan's mosaic, within it.
  Blend(const Camera& camera, const MosaicPlan& plan, const cv::Rect& window);

  /// The pixels of the whole mosaic that a picture may cover; empty where it lies outside.
  static cv::Rect box_of(const Camera& camera, const MosaicPlan& plan, const PlacedPicture& place);

  /// Lays a picture, CV_32F, its grey times `gain`; where they overlap, their order counts.
  void lay(const cv::Mat& picture, const PlacedPicture& place, float gain = 1.0F);

  /// The window, 8-bit. Once; the sums are gone then.
  cv::Mat finish();

 private:
  cv::Mat reduced(const cv::Mat& picture, const Stance& stance) const;

  Camera camera_;
  FloorMap map_;
  bool has_seams_;
  cv::Rect window_;
  ZeroedPixels sums_;
  ZeroedPixels weights_;
};

}  // namespace fathom
