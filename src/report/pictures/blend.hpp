#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/report/mosaic.hpp"
#include "floor_map.hpp"
#include "laid_picture.hpp"
#include "zeroed_pixels.hpp"

namespace fathom {

/// A mosaic, or a window of it, as it accumulates: weighted sums of grey levels, 8 bytes a pixel.
/// With seams there are two bands (Burt and Adelson, A multiresolution spline with application to
/// image mosaics, 1983), 16 bytes: what is broader than a sixth of a picture's shorter side is
/// feathered, what is finer ends at the seam. A pixel of a window has the same bits as of the
/// whole: nothing is computed from where the window begins.
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

  struct Band {
    explicit Band(cv::Size size) : sums(size), weights(size) {}

    WeightedSums from(cv::Point pixel) {
      return {sums.row(pixel.y) + pixel.x, weights.row(pixel.y) + pixel.x};
    }
    void release() {
      sums.release();
      weights.release();
    }

    ZeroedPixels sums;
    ZeroedPixels weights;
  };

  Camera camera_;
  FloorMap map_;
  cv::Rect window_;
  Band fine_;                  ///< feathered, the only one
  std::optional<Band> broad_;  ///< with seams
};

}  // namespace fathom
